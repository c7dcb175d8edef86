#pragma once

#include "contact/master_window.hpp"
#include "contact/segment_candidates.hpp"
#include "contact/segment_parts.hpp"

namespace pliant {

/// Eight slave segments, from (x0, y0) to (x1, y1); a point on one has the coordinate s in [0, 1].
struct SlaveSegments {
  Lanes x0, y0, x1, y1;  ///< m
  Lanes length;          ///< reference or current length, m
};

/// Eight pairs of a slave segment and a segment, or a node, of the master.
struct SegmentPairs {
  LaneBits valid;
  bool of_nodes;
  LaneBits slave, row;  ///< position in the pass; row in the window, for a node that of a segment at it
  SlaveSegments segments;
  Linear along, height;  ///< of the slave, relative to the master's segment from its first node: along it, and outward
  Lanes tangent_x, tangent_y, length, inverse_length;  ///< of the master's segment
};

/// Smaller turns, for unit tangents, count as none: rounding would create a vertex region of no width.
constexpr double least_turn = 1e-12;

/// A node of the master for each of eight slave segments.
struct NodeLanes {
  Lanes x, y;                                  ///< m
  Lanes before_x, before_y, after_x, after_y;  ///< tangents of both segments at the node
  LaneBits convex;
};

/// Finds where the nearest part of a master's outline changes along slave segments (docs/method.md 4).
///
/// Inside, the segments at a convex node share the bisector; outside, the vertex region between their normals belongs
/// to the node. At a re-entrant node it is the reverse. Near the medial axis, in sharp or thin parts and beside short
/// segments, points belong to the nearest of all rivals. Shorter segments next to one are rivals as well; bisectors
/// hold only along their length.
class SegmentCuts {
 public:
  SegmentCuts(const MasterWindow& window, const GapRanges& ranges, std::vector<Span8>& scratch)
      : window_(window), ranges_(ranges), scratch_(scratch) {}

  /// Pairs from candidates; `row`: rows of the master's segments.
  SegmentPairs pairs(const SlaveArc& slaves, LaneBits slave, LaneBits row, LaneBits valid, bool of_nodes) const;
  /// Adds the parts that project on the master's segments.
  void add_segment_parts(const SegmentPairs& pairs, PackedParts& parts) const;
  /// Adds the parts in the vertex regions of nodes.
  void in_fans(const SegmentPairs& pairs, const NodeLanes& nodes, LaneBits rows, PackedParts& parts) const;
  /// Nodes at the start of rows.
  NodeLanes nodes(LaneBits rows) const;

 private:
  struct RelativeToRow {
    Linear along, height;
    Lanes length;
  };
  RelativeToRow relative_to_row(const SlaveSegments& slaves, LaneBits rows) const;
  Linear past_bisector(const SlaveSegments& slaves, LaneBits rows) const;
  Span8 fan_region(const SlaveSegments& slaves, const NodeLanes& nodes, LaneBits rows) const;
  /// The segments next to others, before (-1) or after (1), where these are shorter.
  struct NextLanes {
    LaneBits shorter;
    Lanes length;  ///< m
  };
  NextLanes shorter_next(LaneBits rows, int direction, LaneBits which) const;
  LaneBits may_be_nearer(const SegmentPairs& pairs, LaneBits rows) const;
  void leave_to_rivals(const SegmentPairs& pairs, LaneBits hit, Spans8& spans) const;
  Spans8 nearest_to_node(const SegmentPairs& pairs, const NodeLanes& nodes, LaneBits rows, LaneBits hit,
                         const Span8& fan) const;

  const MasterWindow& window_;
  const GapRanges& ranges_;
  std::vector<Span8>& scratch_;
};

}  // namespace pliant
