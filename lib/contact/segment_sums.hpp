#pragma once

#include <cstddef>
#include <vector>

#include "contact/segment_cuts.hpp"

namespace pliant {

/// Integrals of a quantity times the hat functions of both nodes, over parts of eight slave segments.
struct HatSums {
  Lanes first, second;
  HatSums(Lanes first, Lanes second) : first(first), second(second) {}
  explicit HatSums(const Moments& of) : HatSums(of.plain - of.times_s, of.times_s) {}
  /// Adds them to the sums of the nodes of the pass.
  void add_to(std::vector<double>& of_nodes, const SegmentPairs& pairs, LaneBits hit) const {
    for_each_lane(hit, [&](int lane) {
      double* at = &of_nodes[static_cast<std::size_t>(pairs.slave[lane])];
      at[0] += first[lane], at[1] += second[lane];
    });
  }
};

/// Integrals over all parts of a half pass, by nodes.
struct NodeSums {
  std::vector<double> weight, shear_limit, motion;  ///< m, N/m, m2
  std::vector<double> shear;                        ///< Pa, the traction that results

  void clear(int nodes) {
    for (std::vector<double>* sums : {&weight, &shear_limit, &motion, &shear})
      sums->assign(static_cast<std::size_t>(padded(nodes) + 2 * lane_count), 0.0);
  }
  /// On a whole outline the last node is the first one, which gets the sums of both.
  void close(int segments) {
    for (std::vector<double>* sums : {&weight, &shear_limit, &motion}) (*sums)[0] += (*sums)[segments];
  }
};

/// Forces of eight pairs on both nodes of the slave's segment, N/m.
struct PairForces {
  Lanes x[2], y[2];
};

}  // namespace pliant
