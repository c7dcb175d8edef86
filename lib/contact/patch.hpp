#pragma once

#include <vector>

namespace pliant {

/// A run of consecutive outline nodes. Indices beyond [0, count) continue cyclically; on a wall they reach into the next periods.
struct Arc {
  int begin = 0, count = 0;
};

/// Two bodies that may touch before the next refresh, and the arcs of their outlines that can take part.
struct Patch {
  int first = 0, second = 0;  ///< bodies, first < second
  int images = 0;             ///< periods to add to x of the second to see it from the first
  int law = 0;                ///< index in ContactLaws::laws
  Arc arc[2];                 ///< of the first, of the second
  int record[2] = {0, 0};     ///< first history record of each arc's nodes (padded to whole lanes)
  int force[2] = {0, 0};      ///< first entry of each arc's force buffer: one node more at either end
};

/// Contact history, one record a slave node and other body (METHOD 4): committed on accepted steps only.
struct ContactHistory {
  std::vector<double>
      arc;  ///< arc coordinate of the projection on the master at the last accepted step, m; NaN when not beside it
  std::vector<double> slip;  ///< elastic tangential displacement then, m
};

}  // namespace pliant
