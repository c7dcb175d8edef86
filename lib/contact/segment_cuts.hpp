#pragma once

#include "contact/master_window.hpp"
#include "contact/segment_parts.hpp"
#include "contact/slave_arc.hpp"

namespace pliant {

/// Eight slave segments, from x0, y0 to x1, y1; a point on one is at s in [0, 1].
struct SlaveSegments {
  Lanes x0, y0, x1, y1;  ///< m
  Lanes length;          ///< that counts, m
};

/// Eight pairs of a slave segment and a segment of the master, or a node.
struct SegmentPairs {
  LaneBits valid;
  bool of_nodes;
  LaneBits slave, row;  ///< position in the pass; in the window, of a node of the one that begins or ends there
  SlaveSegments segments;
  Linear along, height;  ///< of the slave, against the master's segment from its first node: along it, and outward
  Lanes tangent_x, tangent_y, length, inverse_length;  ///< of the master's segment
};

/// By less, in terms of tangents' lengths, a node does not turn: rounding would give it a fan of no width.
constexpr double least_turn = 1e-12;

/// A node of the master for each of eight slave segments.
struct NodeLanes {
  Lanes x, y;                                  ///< m
  Lanes before_x, before_y, after_x, after_y;  ///< tangents of its two segments
  LaneBits convex;
};

/// Where the nearest part of a master's outline changes along slave segments (docs/method.md 4).
///
/// Inside, the segments at a convex node share the bisector; outside of it a fan between their normals belongs to the
/// node, and the reverse at a re-entrant one. Where the medial axis is near, in sharp or thin parts and beside short
/// segments, points go to what is nearest of all rivals, of those next to a segment as well: bisectors hold as far as
/// these reach.
class SegmentCuts {
 public:
  SegmentCuts(const MasterWindow& window, const GapRanges& ranges) : window_(window), ranges_(ranges) {}

  /// Of pairs from candidates; `rows`: of the master's segments.
  SegmentPairs pairs(const SlaveArc& slaves, LaneBits slave, LaneBits row, LaneBits valid, bool of_nodes) const;
  /// Parts beside the master's segments.
  void beside(const SegmentPairs& pairs, PackedParts& parts) const;
  /// Parts in the fans of nodes.
  void in_fans(const SegmentPairs& pairs, const NodeLanes& nodes, LaneBits rows, PackedParts& parts) const;
  /// At the start of rows.
  NodeLanes nodes(LaneBits rows) const;

 private:
  struct Beside {
    Linear along, height;
    Lanes length;
  };
  Beside beside_row(const SlaveSegments& slaves, LaneBits rows) const;
  Linear past_bisector(const SlaveSegments& slaves, LaneBits rows) const;
  Span8 fan_beside(const SlaveSegments& slaves, const NodeLanes& nodes, LaneBits rows) const;
  /// Of segments those next to them on a way, -1 or 1, that are shorter.
  struct NextLanes {
    LaneBits shorter;
    Lanes length;  ///< m
  };
  NextLanes shorter_next(LaneBits rows, int way, LaneBits which) const;
  void leave_to_rivals(const SegmentPairs& pairs, LaneBits hit, Spans8& spans) const;
  Spans8 nearest_to_node(const SegmentPairs& pairs, const NodeLanes& nodes, LaneBits rows, LaneBits hit,
                         const Span8& fan) const;

  const MasterWindow& window_;
  const GapRanges& ranges_;
};

}  // namespace pliant
