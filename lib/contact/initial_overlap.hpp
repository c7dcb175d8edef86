#pragma once

#include <string>

#include "contact/contact.hpp"

namespace pliant {

/// Overlaps of bodies at the start of a run. Only penetration counts, not cohesion at a gap.
struct InitialOverlap {
  int pairs = 0;              ///< pairs of bodies that overlap
  int first = 0, second = 0;  ///< the pair with the largest depth
  double depth = 0;           ///< of a node below the other outline, m
  double share = 0;           ///< depth over the longest segment of the master window, as PairTotals::deepest
  double stored = 0;          ///< compression energy of all overlapping contacts, J/m
  double separation = 0;      ///< distance by which the deepest pair must move apart to remove its overlap, m
  double growth = 1;          ///< factor on the pitch of lattices that removes the overlaps of their own grains
};

/// Overlaps of the contact pairs at these outlines.
InitialOverlap initial_overlap(const Model& model, const ContactSystem& contact, const Outlines& outlines);

/// Advice how to remove the overlap.
std::string remedy(const InitialOverlap& overlap, const Model& model);

/// Text with the amount of overlap and advice how to remove it; empty without overlap.
std::string describe(const InitialOverlap& overlap, const Model& model);

}  // namespace pliant
