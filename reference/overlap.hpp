#pragma once

#include <string>

#include "reference/system.hpp"

namespace pliant::reference {

/// Overlaps of bodies at the start. Cohesion at a gap does not count.
struct Overlap {
  int pairs = 0;                ///< pairs of bodies
  double depth = 0, share = 0;  ///< largest penetration, m, and relative to the master's longest segment
  double stored = 0;            ///< in compression, J/m
  std::string first, second;    ///< the deepest pair
};

/// `start`: forces of the first motion, before any was accepted.
Overlap find_overlap(const Bodies& bodies, const Forces& start);

/// Text with advice; empty without overlap.
std::string advice_on(const Overlap& overlap);

}  // namespace pliant::reference
