#pragma once

#include <algorithm>
#include <vector>

#include "contact/pass.hpp"
#include "contact/projection.hpp"

namespace pliant {

/// Eight slave nodes beside a master, and the length of contact that each stands for.
///
/// Only opposing outlines touch. Near a corner of the master a node that is none itself counts as far as it opposes the
/// face, not at all across it, and of its nearest face and the one beyond the corner it touches the one where it stores
/// more: a node of a floor that a block has sunk into would else count as beside the block's flank for as long as that
/// is nearer than the bottom, and lock the block. A corner of the slave touches the one of the two where it stores
/// less, unless it lies on the master's corner. Nothing touches beyond a corner.
///
/// Each of a node's two segments stands for half its length, but for the last two nodes before the end of the master's
/// face, at a corner: they share out what of the face lies there (node_length.cpp), the last one the less the nearer it
/// comes. At a corner of the slave, the segment that opposes the master less than the other counts less, down to
/// nothing; in this the master's direction is not that of the segment, which would jump from one to the next
/// (varying_length.hpp). So two flat faces touch over the length that they share, wherever their nodes are. The energy
/// of a contact is its length times that of its law, and its forces are the gradient of both.
struct Facing {
  /// What a length depends on: the slave's node with its neighbours, the two nodes of the master's segment and the next
  /// ones either way, and the corners at the ends of its face.
  enum Node {
    before,
    itself,
    after,
    segment_start,
    segment_end,
    segment_back,
    segment_on,
    corner_back,
    corner_on,
    nodes
  };

  Facing(const MasterWindow& window, const SlaveNodes& nodes, double outward)
      : p(project(window, nodes.x, nodes.y, outward)), length(nodes.tributary_length) {}

  Projection p;
  Lanes length;          ///< m
  unsigned varying = 0;  ///< one bit a lane: those whose length is not constant
  // Of varying lanes only:
  Vec2 gradient[lane_count][nodes];  ///< of the length by the nodes' places
  int corner_row[lane_count]
                [2];  ///< of the window, whose first nodes are the corners; -1: the length does not depend on it
};

/// Of a segment's length: rounding, where corners lie on each other.
constexpr double tie = 1e-9;

/// How far along a face its corner counts, m.
inline double corner_sight(const OutlineShape& slave, const OutlineShape& master) {
  return std::min(slave.longest, master.longest);
}

/// What a slave node may touch before the next refresh: one face of the master, or of several now one and now another.
struct Footholds {
  /// Of a node of the master, by its row in the window: the most that it carries of the slave's force.
  struct Share {
    int row;
    double share;
  };
  std::vector<Share> shares;
  double factor = 1;  ///< how many times its tributary length the slave stands for at most
  void may_touch(int row, double xi);
};
/// Of one lane of a projection without the rules of corners, from position i of the pass on.
Footholds possible_footholds(const Pass& pass, const MasterWindow& window, const Projection& p, int lane, int i,
                             double outward);

/// Applies the rules of corners to nodes that stand beside the master, from position i of the pass on.
void attend_to_corners(const Pass& pass, const MasterWindow& window, int i, double outward, Facing& facing);

/// From position i of the pass on; at most `outward` off.
inline Facing face(const Pass& pass, const MasterWindow& window, const SlaveNodes& nodes, int i, double outward) {
  if (pass.corners) outward += tie * window.longest();
  Facing facing(window, nodes, outward);
  if (pass.corners) [[unlikely]]
    attend_to_corners(pass, window, i, outward, facing);
  return facing;
}

/// Calls visit(pass, slave side, i) for each eight slave nodes, from position i on, with the master's window filled.
template <class Visit>
void for_each_eight(const PatchView& view, Visit&& visit) {
  const ForceRuns runs = runs_in_table(view.patch);
  for (int slave_side = 0; slave_side < 2; ++slave_side) {
    if (view.patch.nodes[slave_side].count == 0) continue;
    const Pass pass = make_pass(view, slave_side, runs);
    fill_window(view, 1 - slave_side);
    for (int i = 0; i < pass.nodes.count; i += lane_count) visit(pass, slave_side, i);
  }
}

/// Calls visit(pass, slave side, i, facing) where some of the eight touch the master or would, at most `outward` off.
template <class Visit>
void for_each_facing(const PatchView& view, double outward, Visit&& visit) {
  for_each_eight(view, [&](const Pass& pass, int slave_side, int i) {
    if (const Facing at = face(pass, view.window, load_slaves(pass, i), i, outward); any(at.p.hit))
      visit(pass, slave_side, i, at);
  });
}

}  // namespace pliant
