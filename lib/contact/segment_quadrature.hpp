#pragma once

#include <utility>

#include "contact/fan_forces.hpp"
#include "contact/master_window.hpp"
#include "contact/patch.hpp"
#include "contact/segment_parts.hpp"

namespace pliant {

/// Splits eight slave segments where the nearest part of the master's outline changes, and where the law is not smooth,
/// and calls visit(QuadraturePoint) for the points of each part (docs/method.md 4).
///
/// Beside a segment of the master the signed distance is linear along the slave's segment, so that two Gauss points
/// integrate the tractions of piecewise linear laws times hat functions without error. Inside the master segments of a
/// convex corner share the bisector; outside of it a fan between their normals belongs to the node, and the reverse at
/// a re-entrant one. In a fan inside the traction is that of a linear spring to the node, also without error; outside,
/// for laws with a reach, integrals are in closed form unless the fan is narrow. Across the medial axis of a sharp or
/// thin part the nearer side has each point.
template <class Visit>
class SegmentQuadrature {
 public:
  /// `rows`: of the window, that can touch; others are looked at only as what may be nearer.
  SegmentQuadrature(const MasterWindow& window, const Arc& rows, const GapRanges& ranges, const SlaveSegments& slaves,
                    Visit& visit)
      : window_(window),
        rows_(rows),
        ranges_(ranges),
        slaves_(slaves),
        visit_(visit),
        dx_(slaves.x1 - slaves.x0),
        dy_(slaves.y1 - slaves.y0) {}

  void run() {
    Node start, end = node_at(rows_.begin);
    const double first_x = end.x, first_y = end.y;
    around_node(end, rows_.begin, 0);
    const int last = rows_.end() - 1;
    for (int row = rows_.begin; row <= last; ++row) {
      start = end;
      end = node_at(row + 1);
      beside_segment(row, start, end);
      if (row < last)
        around_node(end, row + 1, 0);
      else if (end.x != first_x || end.y != first_y)  // else it is the first one
        around_node(end, row, 1);
    }
  }

 private:
  /// A node of the master, with its tangents; `past`: the bisector there.
  struct Node {
    double x, y;
    double before_x, before_y, after_x, after_y;
    bool convex;
    Linear past;
    /// Three points integrate over an angle a of a fan with an error of (a/4)^6 of it, here below 1e-7.
    bool is_narrow() const { return before_x * after_x + before_y * after_y > 0.966; }
  };
  Node node_at(int row) const {
    const MasterSegment s = window_[row];
    const double at = window_.column(MasterWindow::bisector_at)[row];
    const auto past = [&](Lanes x, Lanes y) {
      return (x - window_.origin_x()) * s.bisector_x + ((y - window_.origin_y()) * s.bisector_y - at);
    };
    return {s.x,
            s.y,
            s.bisector_x - s.tangent_x,
            s.bisector_y - s.tangent_y,
            s.tangent_x,
            s.tangent_y,
            s.bisector_x * s.tangent_y > s.bisector_y * s.tangent_x,
            {past(slaves_.x0, slaves_.y0), past(slaves_.x1, slaves_.y1)}};
  }

  Beside beside(int row) const {
    const MasterSegment m = window_[row];
    const Lanes x0 = slaves_.x0 - m.x, y0 = slaves_.y0 - m.y, x1 = slaves_.x1 - m.x, y1 = slaves_.y1 - m.y;
    return {{x0 * m.tangent_x + y0 * m.tangent_y, x1 * m.tangent_x + y1 * m.tangent_y},
            {x0 * m.tangent_y - y0 * m.tangent_x, x1 * m.tangent_y - y1 * m.tangent_x},
            m.length};
  }

  static void keep(Span8& part, const Linear& positive) { part.keep(positive.at0, positive.at1); }
  static void keep_within(Span8& part, const Linear& value, double low, double high) {
    part.keep(value.at0 - low, value.at1 - low), part.keep(high - value.at0, high - value.at1);
  }

  /// What is nearer to a segment than to its neighbours, on one side of the outline.
  static Span8 between_ends(const Beside& at, const Node& start, const Node& end, bool inside) {
    Span8 part;
    keep(part, inside == start.convex ? start.past : at.along);
    if (inside == end.convex)
      part.keep(-end.past.at0, -end.past.at1);
    else
      part.keep(at.length - at.along.at0, at.length - at.along.at1);
    return part;
  }

  /// Between the perpendiculars at its ends.
  static Span8 strip_of(const Beside& at) {
    Span8 part;
    keep_within(part, at.along, 0, at.length);
    return part;
  }

  double deepest() const { return -ranges_.begin()->low; }

  void beside_segment(int row, const Node& start, const Node& end) {
    const Beside at = beside(row);
    const Linear &along = at.along, &height = at.height;
    const LaneBits near = slaves_.valid & (max(along.at0, along.at1) > 0.0) & (min(along.at0, along.at1) < at.length) &
                          (min(height.at0, height.at1) < ranges_.reach) & (max(height.at0, height.at1) > -deepest());
    if (!any(near)) return;
    for (const GapRange& range : ranges_) {
      const bool inside = range.high <= 0;
      Span8 part = between_ends(at, start, end, inside);
      keep_within(part, height, range.low, range.high);
      if (!inside || !window_.has_medial_neighbours(row)) {
        integrate(row, at, near, part);
        continue;
      }
      for (const Span8& nearest : nearest_to_segment(row, at, part)) integrate(row, at, near, nearest);
    }
  }

  void integrate(int row, const Beside& at, LaneBits near, const Span8& part) {
    const LaneBits hit = near & part.some();
    if (!any(hit)) return;
    const MasterSegment m = window_[row];
    const Lanes way = select(hit, part.high - part.low, Lanes{}), weight = 0.25 * way * slaves_.length;
    const Lanes depth = select(hit, max(-min(at.height.at(part.low), at.height.at(part.high)), Lanes{}), Lanes{});
    constexpr double gauss = 0.21132486540518713;  // 1/2 - 1/sqrt(12)
    for (const double share : {gauss, 1 - gauss}) {
      const Lanes s = part.low + share * way, second = s * weight, first = weight - second;
      visit_(QuadraturePoint{hit,
                             row,
                             false,
                             s,
                             at.along.at(s) * m.inverse_length,
                             at.height.at(s),
                             broadcast(m.tangent_y),
                             broadcast(-m.tangent_x),
                             weight,
                             weight,
                             {first * m.tangent_y, second * m.tangent_y},
                             {first * -m.tangent_x, second * -m.tangent_x},
                             depth});
    }
  }

  /// Without what lies across the medial axis.
  Spans8 nearest_to_segment(int row, const Beside& at, const Span8& part) const {
    Spans8 spans(part);
    window_.for_each_medial_neighbour(row, [&](int other) {
      const Beside there = beside(other);
      Span8 nearer = strip_of(there);
      const double tie = other < row ? 0 : -1e-300;  // one of them has it
      nearer.keep(there.height.at0 - at.height.at0 + tie, there.height.at1 - at.height.at1 + tie);
      nearer.keep(-there.height.at0 - at.height.at0, -there.height.at1 - at.height.at1);
      spans.remove(nearer);
      for (const int end : {other, other + 1}) spans.remove(nearer_to_node(node_at(end), at.height));
    });
    return spans;
  }

  /// In the fan of a node, and nearer to it than to a line at this height: within a parabola.
  Span8 nearer_to_node(const Node& node, const Linear& height) const {
    Span8 fan = fan_of(node);
    const Lanes change = height.at1 - height.at0, x0 = slaves_.x0 - node.x, y0 = slaves_.y0 - node.y;
    const Lanes a = dx_ * dx_ + dy_ * dy_ - change * change, half = x0 * dx_ + y0 * dy_ - height.at0 * change,
                c = x0 * x0 + y0 * y0 - height.at0 * height.at0, discriminant = half * half - a * c;
    const LaneBits some = (a > 0.0) & (discriminant > 0.0);
    const Lanes root = sqrt(max(discriminant, Lanes{})), inverse = 1.0 / select(some, a, broadcast(1));
    fan.low = max(fan.low, select(some, (-half - root) * inverse, fan.low));
    fan.high = select(some, min(fan.high, (root - half) * inverse), broadcast(-1));
    return fan;
  }

  /// But for what all nodes have in common, of second order along the segment.
  Linear squared_distance(const Node& node) const {
    const auto at = [&](Lanes x, Lanes y) { return (x - node.x) * (x - node.x) + (y - node.y) * (y - node.y); };
    return {at(slaves_.x0, slaves_.y0), at(slaves_.x1, slaves_.y1)};
  }

  /// Between the normals of both segments.
  Span8 fan_of(const Node& node) const {
    const Lanes x0 = slaves_.x0 - node.x, y0 = slaves_.y0 - node.y, x1 = slaves_.x1 - node.x, y1 = slaves_.y1 - node.y;
    const Linear before{x0 * node.before_x + y0 * node.before_y, x1 * node.before_x + y1 * node.before_y},
        after{x0 * node.after_x + y0 * node.after_y, x1 * node.after_x + y1 * node.after_y};
    Span8 fan;
    fan.keep(before.at0, before.at1), fan.keep(-after.at0, -after.at1);
    // On the normal itself there is none: the fan of a straight node has no width.
    fan.high = select((before.at0 == 0.0) & (before.at1 == 0.0), broadcast(-1), fan.high);
    fan.high = select((after.at0 == 0.0) & (after.at1 == 0.0), broadcast(-1), fan.high);
    return fan;
  }

  /// Without what is nearer to segments across the medial axis.
  Spans8 nearest_to_node(const Node& node, int row, bool at_end, const Span8& fan) const {
    Spans8 spans(fan);
    window_.for_each_medial_neighbour_of_node(row, at_end, [&](int other) {
      const Beside there = beside(other);
      const Span8 others = strip_of(there), mine = nearer_to_node(node, there.height);
      const LaneBits some = mine.some();
      spans.remove({others.low, select(some, min(others.high, mine.low), others.high)});
      spans.remove({select(some, max(others.low, mine.high), broadcast(1)), others.high});
      for (const int end : {other, other + 1}) {
        const Node rival = node_at(end);
        Span8 nearer = fan_of(rival);
        keep(nearer, squared_distance(node) - squared_distance(rival));
        spans.remove(nearer);
      }
    });
    return spans;
  }

  /// The fan of a node, which is at xi on the row.
  void around_node(const Node& node, int row, double xi) {
    const bool inside = !node.convex;
    if (!inside && ranges_.reach <= 0) return;
    const Span8 fan = fan_of(node);
    const Lanes x0 = slaves_.x0 - node.x, y0 = slaves_.y0 - node.y;
    const Lanes square = dx_ * dx_ + dy_ * dy_, foot = -(x0 * dx_ + y0 * dy_) / square;
    const Lanes across = x0 * dy_ - y0 * dx_, nearest = across * across / square;  // squared distance of the line
    const double radius = inside ? deepest() : ranges_.reach;
    const LaneBits near = slaves_.valid & fan.some() & (nearest < radius * radius);
    if (!any(near)) return;
    const auto half_chord = [&](double r) { return sqrt(max(r * r - nearest, Lanes{}) / square); };
    const Spans8 spans = inside ? nearest_to_node(node, row, xi > 0, fan) : Spans8(fan);
    for (const Span8& span : spans)
      for (const GapRange& range : ranges_) {
        if (inside != (range.high <= 0)) continue;
        const Lanes outer = half_chord(inside ? -range.low : range.high),
                    inner = half_chord(inside ? -range.high : range.low);
        for (const Span8& part : {Span8{max(span.low, foot - outer), min(span.high, foot - inner)},
                                  Span8{max(span.low, foot + inner), min(span.high, foot + outer)}}) {
          const bool by_points = inside || node.is_narrow();
          integrate_fan(node, row, xi, near, part, by_points);
          const LaneBits hit = near & part.some();
          if (by_points || !any(hit)) continue;
          const QuadraturePoint of{hit, row, true, {}, broadcast(xi), {}, {}, {}, {}, {}, {}, {}, {}};
          visit_fan_forces(x0, y0, dx_, dy_, slaves_.length, part, range, of, visit_);
        }
      }
  }

  /// `has_forces`: or others of their own follow.
  void integrate_fan(const Node& node, int row, double xi, LaneBits near, const Span8& part, bool has_forces) {
    const LaneBits hit = near & part.some();
    if (!any(hit)) return;
    const bool inside = !node.convex;
    const Lanes way = select(hit, part.high - part.low, Lanes{});
    const auto point = [&](double share, double of_length) {
      const Lanes s = part.low + share * way, x = slaves_.x0 - node.x + s * dx_, y = slaves_.y0 - node.y + s * dy_,
                  square = x * x + y * y;
      const LaneBits apart = square > 0.0;
      const Lanes inverse = select(apart, 1.0 / sqrt(select(apart, square, broadcast(1))), Lanes{});
      const Lanes outward = inside ? -inverse : inverse, distance = square * inverse;
      const Lanes weight = (0.5 * of_length) * way * slaves_.length, normal_x = x * outward, normal_y = y * outward;
      const Lanes energy_weight = has_forces ? weight : Lanes{}, second = s * energy_weight,
                  first = energy_weight - second;
      visit_(QuadraturePoint{hit,
                             row,
                             true,
                             s,
                             broadcast(xi),
                             inside ? -distance : distance,
                             normal_x,
                             normal_y,
                             weight,
                             energy_weight,
                             {first * normal_x, second * normal_x},
                             {first * normal_y, second * normal_y},
                             inside ? select(hit, distance, Lanes{}) : Lanes{}});
    };
    constexpr double gauss = 0.1127016653792583;  // 1/2 - sqrt(3/20)
    point(gauss, 5.0 / 18), point(0.5, 8.0 / 18), point(1 - gauss, 5.0 / 18);
  }

  const MasterWindow& window_;
  Arc rows_;
  const GapRanges& ranges_;
  const SlaveSegments& slaves_;
  Visit& visit_;
  Lanes dx_, dy_;  ///< of the slaves
};

template <class Visit>
void for_each_point(const MasterWindow& window, const Arc& rows, const GapRanges& ranges, const SlaveSegments& slaves,
                    Visit&& visit) {
  if (rows.count > 0) SegmentQuadrature<Visit>(window, rows, ranges, slaves, visit).run();
}

}  // namespace pliant
