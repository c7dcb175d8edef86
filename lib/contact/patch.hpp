#pragma once

#include <vector>

namespace pliant {

/// A run of consecutive outline nodes or segments (a segment bears its first node's number). Numbers beyond [0, count) of the outline continue
/// cyclically; on a wall they reach into the next periods.
struct Arc {
  int begin = 0, count = 0;
  int end() const { return begin + count; }
};

/// Two bodies that may touch before the next refresh, and the parts of their outlines that can take part.
struct Patch {
  int first = 0, second = 0;  ///< bodies, first < second
  int images = 0;             ///< periods to add to x of the second to see it from the first
  int law = 0;                ///< index in ContactLaws::laws
  Arc nodes[2];               ///< that may touch the other body; no node twice
  Arc segments[2];            ///< that the other's nodes may touch
  int record[2] = {0, 0};     ///< first history record of each side's nodes (padded to whole lanes)
  int force[2] = {0, 0};      ///< first entry of each side's force buffer, which begins at node forces(side).begin

  /// Outline nodes that this patch puts forces on.
  Arc forces(int side) const {
    const Arc &n = nodes[side], &s = segments[side];
    if (s.count == 0) return n;
    if (n.count == 0) return {s.begin, s.count + 1};
    const int begin = n.begin < s.begin ? n.begin : s.begin, end = n.end() > s.end() + 1 ? n.end() : s.end() + 1;
    return {begin, end - begin};
  }
};

/// Contact history, one record a slave node and other body (METHOD 4): committed on accepted steps only.
struct ContactHistory {
  std::vector<double>
      place;  ///< on the master's outline at the last accepted step, see slip.hpp; NaN when not beside it
  std::vector<double> slip;  ///< elastic tangential displacement then, m
};

}  // namespace pliant
