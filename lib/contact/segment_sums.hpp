#pragma once

#include <cstddef>
#include <vector>

#include "core/lanes.hpp"

namespace pliant {

inline void add(double* to, Lanes value) { store(to, load(to) + value); }

/// Values at both ends of eight segments, and between them.
struct Ends {
  Lanes first, second;
  Lanes at(Lanes s) const { return (1.0 - s) * first + s * second; }
};

/// Sums over the quadrature points at each slave node, times its hat function.
struct NodeSums {
  std::vector<double> weight, shear_limit, motion;  ///< m, N/m, m2
  std::vector<double> shear;                        ///< Pa, what comes of them

  void clear(int nodes) {
    for (std::vector<double>* sums : {&weight, &shear_limit, &motion, &shear})
      sums->assign(static_cast<std::size_t>(padded(nodes) + 2 * lane_count), 0.0);
  }
  /// The last node of a whole outline is the first one.
  void close(int segments) {
    for (std::vector<double>* sums : {&weight, &shear_limit, &motion}) (*sums)[0] += (*sums)[segments];
  }
};

inline void add_to_nodes(std::vector<double>& sums, int i, Lanes s, Lanes value) {
  add(&sums[i], (1.0 - s) * value), add(&sums[i + 1], s * value);
}

}  // namespace pliant
