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

/// A node of the master for each of eight slave segments.
struct NodeLanes {
  Lanes x, y;                                  ///< m
  Lanes before_x, before_y, after_x, after_y;  ///< tangents of its two segments
  LaneBits convex;
  /// Three points integrate over an angle a of a fan with an error of (a/4)^6 of it, here below 1e-7.
  LaneBits narrow() const { return before_x * after_x + before_y * after_y > 0.966; }
};

/// Where the nearest part of a master's outline changes along slave segments (docs/method.md 4).
///
/// Inside, the segments at a convex node share the bisector; outside of it a fan between their normals belongs to the
/// node, and the reverse at a re-entrant one. Across the medial axis of a sharp or thin part the nearer side has each
/// point.
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
  Spans8 nearest_to_segment(const SegmentPairs& pairs, LaneBits hit, const Span8& part) const;
  Spans8 nearest_to_node(const SegmentPairs& pairs, const NodeLanes& nodes, LaneBits rows, LaneBits hit,
                         const Span8& fan) const;

  const MasterWindow& window_;
  const GapRanges& ranges_;
};

}  // namespace pliant
