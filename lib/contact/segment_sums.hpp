#pragma once

#include <cstddef>
#include <vector>

#include "contact/segment_cuts.hpp"

namespace pliant {

/// Integrals over parts of eight slave segments of something times the hat functions of their two nodes.
struct HatSums {
  Lanes first, second;
  HatSums(Lanes first, Lanes second) : first(first), second(second) {}
  explicit HatSums(const Moments& of) : HatSums(of.plain - of.times_s, of.times_s) {}
  /// To a number of each node in the pass.
  void add_to(std::vector<double>& of_nodes, const SegmentPairs& pairs, LaneBits hit) const {
    for_each_lane(hit, [&](int lane) {
      double* at = &of_nodes[static_cast<std::size_t>(pairs.slave[lane])];
      at[0] += first[lane], at[1] += second[lane];
    });
  }
};

/// Of the nodes of a pass: integrals over all parts.
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

/// Forces of eight pairs on both nodes of the slave's segment, N/m.
struct PairForces {
  Lanes x[2], y[2];
};

}  // namespace pliant
