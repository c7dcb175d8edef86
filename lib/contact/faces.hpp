#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "contact/facing.hpp"

namespace pliant {

inline Vec2 tangent(const MasterSegment& s) { return {s.tangent_x, s.tangent_y}; }
inline Vec2 start(const MasterSegment& s) { return {s.x, s.y}; }
inline Vec2 outward_of(const Vec2& tangent) { return {tangent.y(), -tangent.x()}; }

/// A slave node with its two segments: [0] the one before it, [1] the one after it.
struct SlaveNode {
  Vec2 at, neighbour[2];
  Vec2 direction[2];  ///< unit tangents
  double present[2];  ///< lengths now, m
  double length[2];   ///< that count, m: of the reference outline, or now
  bool corner;
  bool beside_corner[2];  ///< the neighbour is one

  /// Cosine between a segment's normal, turned round, and the normal of a tangent on the master.
  double opposition(int side, const Vec2& to) const { return -direction[side].dot(to); }
  /// Of the segment that opposes better.
  int opposing_side(const Vec2& to) const { return opposition(0, to) > opposition(1, to) ? 0 : 1; }
};

SlaveNode slave_node(const Pass& pass, int index);

/// Where a face ends at a corner.
struct FaceEnd {
  int row;     ///< the last one
  int corner;  ///< row of which the corner is the first node; count() for the window's last node
};

/// The master's faces in a window. A way is 1 along the outline and -1 against it.
class Faces {
 public:
  Faces(const Pass& pass, const MasterWindow& window)
      : shape_(*pass.master), window_(window), sight_(corner_sight(*pass.slave, *pass.master)) {}

  /// Row of the face beyond the next corner on a way from the row that a node is beside; -1: no corner near, or not
  /// beside that face. A corner of the slave may also lie inside a blunt corner, past the beginning of that face.
  int beyond(const SlaveNode& node, int row, int way, double outward) const {
    const std::optional<FaceEnd> end = end_of_face(node, row, way, 2 * sight_ + outward);
    if (!end) return -1;
    const int other = wrapped(end->row + way);
    return in_window(other) ? beside(node, other, way, outward) : -1;
  }

  /// Whether the node lies beyond a corner at an end of the row.
  bool beyond_corner(const SlaveNode& node, int row) const {
    if (!shape_.has_corners()) return false;
    return (ends_at_corner(row, -1) && is_past({row, row}, -1, node.at)) ||
           (ends_at_corner(row, 1) && is_past({row, row + 1}, 1, node.at));
  }

  /// The end of a row's face, no further off than `limit` from beside the node.
  std::optional<FaceEnd> end_of_face(const SlaveNode& node, int row, int way, double limit) const {
    if (!shape_.has_corners()) return {};
    const MasterSegment s = window_[row];
    const double along = std::clamp((node.at - start(s)).dot(tangent(s)), 0.0, s.length);
    double distance = way < 0 ? along : s.length - along;
    while (distance <= limit && !ends_at_corner(row, way)) {
      row = wrapped(row + way);
      if (!in_window(row)) return {};
      distance += window_[row].length;
    }
    if (distance > limit) return {};
    return FaceEnd{row, way < 0 ? row : row + 1};
  }

  /// Whether a point lies beyond the end of a face.
  bool is_past(const FaceEnd& end, int way, const Vec2& point) const {
    const MasterSegment s = window_[end.row];
    return way * (point - start(window_[end.corner])).dot(tangent(s)) > tie * s.length;
  }

  /// Whether the first node of a row, or the last row's end, is a corner.
  bool is_corner(int row) const { return shape_.has_corners() && shape_.corner[window_.number(row)]; }

  double sight() const { return sight_; }
  double height(const SlaveNode& node, int row) const {
    return (node.at - start(window_[row])).dot(outward_of(tangent(window_[row])));
  }

  Vec2 corner_place(const FaceEnd& end) const { return start(window_[end.corner]); }

 private:
  bool in_window(int row) const { return row >= 0 && row < window_.count(); }
  /// A window of a whole closed outline goes on around it.
  int wrapped(int row) const {
    const int n = window_.count();
    return n == window_.outline_count() && shape_.turn_shift == 0 ? (row + n) % n : row;
  }
  bool ends_at_corner(int row, int way) const { return is_corner(way < 0 ? row : row + 1); }

  /// Where on the face that begins beyond a corner, with this row, the node stands; -1: not beside it, or too far off.
  int beside(const SlaveNode& node, int row, int way, double outward) const {
    if (is_past({row, way < 0 ? row + 1 : row}, -way, node.at)) {
      const double h = height(node, row);
      return node.corner && h <= outward && h >= -window_.depth() ? row : -1;
    }
    const auto past_bisector = [&](int r) {
      const MasterSegment s = way < 0 ? window_[r] : window_[r + 1];
      const double from = (node.at - start(s)).dot(Vec2(s.bisector_x, s.bisector_y));
      return way < 0 ? from < 0 : from >= 0;
    };
    while (!ends_at_corner(row, way) && past_bisector(row)) {
      row = wrapped(row + way);
      if (!in_window(row)) return -1;
    }
    const double h = height(node, row);
    return beyond_corner(node, row) || h > outward || h < -window_.depth() ? -1 : row;
  }

  const OutlineShape& shape_;
  const MasterWindow& window_;
  double sight_;  ///< m
};

/// Length of contact that a node stands for beside a row of the master, and what it depends on.
struct NodeLength {
  double value = 0;  ///< m
  bool varies = false;
  std::array<Vec2, Facing::nodes> gradient;
  int corner_row[2] = {-1, -1};  ///< as in Facing
};
/// How a row counts: as the nearest one does; as one beyond a corner from there, where the node is not deep; or, for a
/// corner of the slave on the line of its nearest row, as one that begins there.
enum class RowKind { nearest, beyond_corner, at_corner };
NodeLength node_length(const SlaveNode& node, const MasterWindow& window, const Faces& faces, int row, RowKind kind);
/// The row that a node touches, its nearest one or one beyond a corner, and the length that it stands for there: a
/// corner of the slave the one where it stores less, as it leaves the master through either, unless it is hardly deep;
/// any other node where it stores more.
struct Foothold {
  int row;
  NodeLength length;
};
Foothold foothold(const SlaveNode& node, const MasterWindow& window, const Faces& faces, int row, double outward);

}  // namespace pliant
