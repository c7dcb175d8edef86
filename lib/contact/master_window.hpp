#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "bodies/outline_fields.hpp"
#include "contact/contact_pair.hpp"
#include "core/lanes.hpp"

namespace pliant {

/// Tolerance of the bisector test over the segment length: about twice the distance before a bisector at which nodes
/// count as beyond it. A node that is on a bisector by symmetry thus belongs to the segment after it, whatever the
/// rounding.
constexpr double ties_up_to = 1e-9;

/// Geometry of one master segment.
struct MasterSegment {
  double x, y;  ///< first node, m
  double tangent_x, tangent_y;
  double length, inverse_length;
  double mean_length;             ///< see MasterWindow::fill, m
  double bisector_x, bisector_y;  ///< at the first node: sum of the two segments' tangents, normal to the bisector
};

/// Segments of one arc of a master, rebuilt at every evaluation.
class MasterWindow {
 public:
  enum Column {
    x,
    y,
    tangent_x,
    tangent_y,
    length,
    inverse_length,
    mean_length,
    bisector_x,
    bisector_y,
    bisector_at,
    columns
  };

  /// `inward`: detection depth below a segment in excess of the longest segment's length, m. `before`: the outline at
  /// the start of the step, x and y, for mean lengths over the step; null: the present ones serve.
  void fill(const OutlineShape& shape, const double* outline_x, const double* outline_y, const Arc& segments,
            const Vec2& shift, double inward, const std::array<const double*, 2>& before = {});

  int count() const { return count_; }
  /// Values of all rows from 0 on. There is one row more than segments, for the end node of the last.
  const double* column(Column c) const { return reinterpret_cast<const double*>(&entries_[c * stride_]); }
  MasterSegment operator[](int row) const {
    const auto entry = [&](Column c) { return column(c)[row]; };
    return {entry(x),           entry(y),          entry(tangent_x),
            entry(tangent_y),   entry(length),     entry(inverse_length),
            entry(mean_length), entry(bisector_x), entry(bisector_y)};
  }
  /// Entries of rows in [0, count()], one per lane.
  Lanes entries(Column c, LaneBits rows) const {
    return count_ < 2 * lane_count ? look_up(column(c), rows) : gather(column(c), rows);
  }
  /// Origin of the coordinates along bisector normals, at the first node. Column bisector_at has these coordinates of
  /// the nodes.
  double origin_x() const { return column(x)[0]; }
  double origin_y() const { return column(y)[0]; }
  double longest() const { return longest_; }  ///< length of the longest segment, m
  /// Length of the segment before the row's, m.
  double length_before(int row) const { return row == 0 ? before_ : column(length)[row - 1]; }
  double depth() const { return depth_; }  ///< detection depth below each segment, m
  int outline_count() const { return outline_count_; }
  /// Number of a row's segment in its outline, in [0, outline_count()).
  int number(int row) const {
    return first_number_ + row - turn_of(first_number_ + row, outline_count_) * outline_count_;
  }
  bool has_medial_neighbours() const { return !shape_->medial.offset.empty() || !shape_->node_medial.offset.empty(); }
  /// Number of rivals, segments to which points below a row's segment may be nearer although bisectors do not show it.
  /// They are its medial neighbours and, if it has some, first of all the segments before and behind it, if these are
  /// shorter.
  std::size_t rivals(int row) const {
    const std::size_t medial = shape_->medial.of(number(row)).size();
    return medial == 0 ? 0 : medial + 2;
  }
  /// Row of the k-th rival; -1: it is not in the window or, before or behind the segment, not shorter.
  int rival(int row, std::size_t k) const {
    if (k < 2) return shape_->shorter_next[number(row)][k] ? row_at(row, k == 0 ? -1 : 1) : -1;
    return row_at(row, shape_->medial.of(number(row))[k - 2]);
  }
  /// Number of rivals of the node at a row's start: medial neighbours alone.
  std::size_t rivals_of_node(int row) const { return shape_->node_medial.of(number(row)).size(); }
  int rival_of_node(int row, std::size_t k) const { return row_at(row, shape_->node_medial.of(number(row))[k]); }
  /// The numbers, see number(), of eight rows.
  Lanes numbers(Lanes rows) const {
    const double n = outline_count_;
    const Lanes number = first_number_ + rows;
    return number - n * round_to_integer((number - 0.5 * (n - 1)) * (1 / n));
  }

 private:
  /// Row that is `offset` segments further; -1: not in the window.
  int row_at(int row, int offset) const {
    int other = row + offset;
    if (shape_->turn_shift == 0 && (other < 0 || other >= count_))
      other += other < 0 ? outline_count_ : -outline_count_;
    return other >= 0 && other < count_ ? other : -1;
  }

  const OutlineShape* shape_ = nullptr;
  int count_ = 0, outline_count_ = 0, first_number_ = 0;
  double longest_ = 0, depth_ = 0;
  double before_ = 0;           ///< length of the segment before the first
  std::size_t stride_ = 0;      ///< vectors per column
  std::vector<Lanes> entries_;  ///< [columns][stride]
};

/// One window per thread, so that its memory is allocated once.
inline MasterWindow& thread_scratch() {
  thread_local MasterWindow window;
  return window;
}

}  // namespace pliant
