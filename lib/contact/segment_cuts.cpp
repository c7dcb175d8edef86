#include "contact/segment_cuts.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace pliant {
namespace {

using Column = MasterWindow::Column;

/// Part between the perpendiculars at the ends of a segment, and rounding beyond. A point on a perpendicular is as near
/// to the segment as to its end.
Span8 strip_of(const Linear& along, Lanes length) {
  const Lanes end = (1 + Span8::rounding) * length, start = length - end;
  Span8 part;
  part.keep({along.at0 - start, along.at1 - start});
  part.keep({end - along.at0, end - along.at1});
  return part;
}

/// Vectors from nodes to the ends of slave segments.
struct FromNode {
  Lanes x0, y0, x1, y1;
  FromNode(const SlaveSegments& slaves, const NodeLanes& nodes)
      : x0(slaves.x0 - nodes.x), y0(slaves.y0 - nodes.y), x1(slaves.x1 - nodes.x), y1(slaves.y1 - nodes.y) {}
  Linear along(Lanes tx, Lanes ty) const { return {x0 * tx + y0 * ty, x1 * tx + y1 * ty}; }
};

/// Part between the normals of both segments of a node, past the end of the one and before the start of the other.
Span8 fan_between(const Linear& before, const Linear& after) {
  Span8 fan;
  fan.keep(before), fan.keep({-after.at0, -after.at1});
  // There is no part on the normal itself: the vertex region of a straight node has no width.
  const LaneBits on_normal = ((before.at0 == 0.0) & (before.at1 == 0.0)) | ((after.at0 == 0.0) & (after.at1 == 0.0));
  fan.high = select(on_normal, broadcast(-1), fan.high);
  return fan;
}

Span8 fan_of(const SlaveSegments& slaves, const NodeLanes& nodes) {
  const FromNode from(slaves, nodes);
  return fan_between(from.along(nodes.before_x, nodes.before_y), from.along(nodes.after_x, nodes.after_y));
}

/// Part in the vertex region of a node and nearer to it than to a line at this height: within a parabola.
Span8 nearer_to_node(const SlaveSegments& slaves, const NodeLanes& nodes, const Linear& height) {
  Span8 fan = fan_of(slaves, nodes);
  const Lanes dx = slaves.x1 - slaves.x0, dy = slaves.y1 - slaves.y0;
  const Lanes change = height.at1 - height.at0, x0 = slaves.x0 - nodes.x, y0 = slaves.y0 - nodes.y;
  // Solves a s^2 + 2 half s + c < 0. If the slave is normal to the line, a is rounding, and there may be one root only.
  const Lanes square = dx * dx + dy * dy, a = square - change * change, half = x0 * dx + y0 * dy - height.at0 * change,
              c = x0 * x0 + y0 * y0 - height.at0 * height.at0, discriminant = half * half - a * c;
  constexpr double rounding = 1e-14;
  const LaneBits curved = a > rounding * square, some = curved & (discriminant > 0.0);
  Span8 straight;
  straight.keep({-c, -c - 2.0 * half});
  const Lanes root = sqrt(max(discriminant, Lanes{})), larger = -half - select(half < 0.0, -root, root);
  const Lanes one = larger / select(some, a, broadcast(1)),
              other = select(larger != 0.0, c / select(larger != 0.0, larger, broadcast(1)), Lanes{});
  const Lanes low = select(curved, min(one, other), straight.low),
              high = select(curved, max(one, other), straight.high);
  fan.low = max(fan.low, low);
  fan.high = select(some | ~curved, min(fan.high, high), broadcast(-1));
  return fan;
}

/// Squared distance without a term of second order along the segment, which all nodes have in common.
Linear squared_distance(const SlaveSegments& slaves, const NodeLanes& nodes) {
  const FromNode from(slaves, nodes);
  return {from.x0 * from.x0 + from.y0 * from.y0, from.x1 * from.x1 + from.y1 * from.y1};
}

Span8 only(LaneBits which, const Span8& part) { return {part.low, select(which, part.high, broadcast(-1))}; }

/// Lanes one by one. A vector is taken apart once, as each access to a lane of it waits for a store.
std::array<std::int64_t, lane_count> numbers_of(LaneBits lanes) {
  std::array<std::int64_t, lane_count> numbers;
  std::memcpy(numbers.data(), &lanes, sizeof lanes);
  return numbers;
}

/// The lanes whose bits are set: the reverse of bits().
LaneBits lanes_of(unsigned mask) {
  const LaneBits bit = {1, 2, 4, 8, 16, 32, 64, 128};
  return ((LaneBits{} + static_cast<std::int64_t>(mask)) & bit) != 0;
}

/// Calls visit(LaneBits rows, LaneBits lanes that have one) for the rows in the lists of eight others, one from each at
/// a time.
template <class Count, class Neighbour, class Visit>
void for_each_neighbour(LaneBits rows, LaneBits hit, const Count& count, const Neighbour& neighbour, Visit&& visit) {
  const unsigned hits = bits(hit);
  const std::array<std::int64_t, lane_count> row = numbers_of(rows);
  std::array<std::size_t, lane_count> counts{};
  std::size_t most = 0;
  for (unsigned left = hits; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    most = std::max(most, counts[lane] = count(static_cast<int>(row[lane])));
  }
  for (std::size_t k = 0; k < most; ++k) {
    std::array<std::int64_t, lane_count> number = row;
    unsigned found = 0;
    for (unsigned left = hits; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      if (k >= counts[lane]) continue;
      if (const int other = neighbour(static_cast<int>(row[lane]), k); other >= 0)
        number[lane] = other, found |= 1u << lane;
    }
    if (found == 0) continue;
    visit(load(number.data()), lanes_of(found));
  }
}

}  // namespace

SegmentPairs SegmentCuts::pairs(const SlaveArc& slaves, LaneBits slave, LaneBits row, LaneBits valid,
                                bool of_nodes) const {
  const double *x = slaves.x.data(), *y = slaves.y.data();
  SegmentPairs pairs{valid,
                     of_nodes,
                     slave,
                     row,
                     {gather(x, slave), gather(y, slave), gather(x + 1, slave), gather(y + 1, slave),
                      gather(slaves.lengths.data(), slave)},
                     {},
                     {},
                     window_.entries(Column::tangent_x, row),
                     window_.entries(Column::tangent_y, row),
                     window_.entries(Column::length, row),
                     window_.entries(Column::inverse_length, row)};
  const auto [along, height, length] = relative_to_row(pairs.segments, row);
  pairs.along = along, pairs.height = height;
  return pairs;
}

NodeLanes SegmentCuts::nodes(LaneBits rows) const {
  const auto entries = [&](Column c) { return window_.entries(c, rows); };
  NodeLanes n{entries(Column::x),         entries(Column::y),         {}, {},
              entries(Column::tangent_x), entries(Column::tangent_y), {}};
  const Lanes bisector_x = entries(Column::bisector_x), bisector_y = entries(Column::bisector_y);
  n.before_x = bisector_x - n.after_x, n.before_y = bisector_y - n.after_y;
  n.convex = bisector_x * n.after_y > bisector_y * n.after_x;
  return n;
}

SegmentCuts::RelativeToRow SegmentCuts::relative_to_row(const SlaveSegments& slaves, LaneBits rows) const {
  const auto entries = [&](Column c) { return window_.entries(c, rows); };
  const Lanes mx = entries(Column::x), my = entries(Column::y), tx = entries(Column::tangent_x),
              ty = entries(Column::tangent_y);
  const Lanes x0 = slaves.x0 - mx, y0 = slaves.y0 - my, x1 = slaves.x1 - mx, y1 = slaves.y1 - my;
  return {{x0 * tx + y0 * ty, x1 * tx + y1 * ty}, {x0 * ty - y0 * tx, x1 * ty - y1 * tx}, entries(Column::length)};
}

Linear SegmentCuts::past_bisector(const SlaveSegments& slaves, LaneBits rows) const {
  const auto entries = [&](Column c) { return window_.entries(c, rows); };
  const Lanes mx = entries(Column::x), my = entries(Column::y), bx = entries(Column::bisector_x),
              by = entries(Column::bisector_y);
  return {(slaves.x0 - mx) * bx + (slaves.y0 - my) * by, (slaves.x1 - mx) * bx + (slaves.y1 - my) * by};
}

void SegmentCuts::add_segment_parts(const SegmentPairs& pairs, PackedParts& parts) const {
  const auto& [along, height] = std::pair(pairs.along, pairs.height);
  const LaneBits rows = pairs.row, next = rows + 1;
  const auto turn = [&](LaneBits of) {
    return window_.entries(Column::bisector_x, of) * window_.entries(Column::tangent_y, of) -
           window_.entries(Column::bisector_y, of) * window_.entries(Column::tangent_x, of);
  };
  const Lanes start_turn = turn(rows), end_turn = turn(next);
  const Linear start = past_bisector(pairs.segments, rows), end = past_bisector(pairs.segments, next),
               before_end{pairs.length - along.at0, pairs.length - along.at1};
  const Levels levels(height);
  for (const bool inside : {true, false}) {
    if (!inside && ranges_.reach <= 0) break;
    const LaneBits near =
        pairs.valid & (inside ? min(height.at0, height.at1) < 0.0 : max(height.at0, height.at1) > 0.0);
    if (!any(near)) continue;
    // Part nearer to a segment than to its neighbours, on one side of the outline.
    Span8 part;
    const bool has_rivals = inside && window_.has_medial_neighbours();
    // Cut by the bisector, unless a vertex region is between.
    LaneBits by_start = (inside ? start_turn : -start_turn) > -least_turn,
             by_end = (inside ? end_turn : -end_turn) > -least_turn;
    const NextLanes before = has_rivals ? shorter_next(rows, -1, by_start & near) : NextLanes{},
                    after = has_rivals ? shorter_next(rows, 1, by_end & near) : NextLanes{};
    by_start &= ~before.shorter, by_end &= ~after.shorter;
    part.keep(select(by_start, start, along));
    part.keep(select(by_end, {-end.at0, -end.at1}, before_end), by_end);
    if (!any(near & part.some())) continue;
    Spans8 spans(part, scratch_);
    if (has_rivals) {
      // Removes the part past the bisector, as far as its points project onto the next segment.
      const auto remove_past = [&](const NextLanes& next, const Linear& bisector, const Linear& from_node) {
        Span8 past = only(next.shorter, {});
        past.keep({-bisector.at0, -bisector.at1});
        past.keep({next.length - from_node.at0, next.length - from_node.at1});
        spans.remove(past);
      };
      remove_past(before, start, along), remove_past(after, {-end.at0, -end.at1}, before_end);
      leave_to_rivals(pairs, near & part.some(), spans);
    }
    for (const GapRange& range : ranges_) {
      if (range.is_inside() != inside) continue;
      const Levels::Between within = levels.between(range.low, range.high);
      for (const Span8& span : spans) parts.put(near, {max(span.low, within.low), min(span.high, within.high)}, range);
    }
  }
}

SegmentCuts::NextLanes SegmentCuts::shorter_next(LaneBits rows, int direction, LaneBits which) const {
  const std::array<std::int64_t, lane_count> row = numbers_of(rows);
  std::array<double, lane_count> length{};
  unsigned shorter = 0;
  for_each_lane(which, [&](int lane) {
    const int here = static_cast<int>(row[static_cast<std::size_t>(lane)]);
    if (window_.rivals(here) == 0) return;
    const int other = window_.rival(here, direction < 0 ? 0 : 1);
    if (other < 0) return;
    shorter |= 1u << lane, length[static_cast<std::size_t>(lane)] = window_[other].length;
  });
  if (shorter == 0) return NextLanes{LaneBits{}, Lanes{}};
  return {lanes_of(shorter), load(length.data())};
}

/// Which segments may come as near to a slave segment as its deepest point is to the segment of its pair: circles
/// around both overlap, of which that of the slave is larger by its depth. Shallow contacts thus have few rivals.
LaneBits SegmentCuts::may_be_nearer(const SegmentPairs& pairs, LaneBits rows) const {
  const auto entries = [&](Column c) { return window_.entries(c, rows); };
  const SlaveSegments& slaves = pairs.segments;
  const Lanes half = 0.5 * entries(Column::length);
  const Lanes dx = 0.5 * (slaves.x0 + slaves.x1) - entries(Column::x) - half * entries(Column::tangent_x),
              dy = 0.5 * (slaves.y0 + slaves.y1) - entries(Column::y) - half * entries(Column::tangent_y);
  const Lanes wx = slaves.x1 - slaves.x0, wy = slaves.y1 - slaves.y0,
              depth = -min(min(pairs.height.at0, pairs.height.at1), Lanes{});
  constexpr double rounding = 1 + 1e-6;
  const Lanes reach = rounding * (half + 0.5 * sqrt(wx * wx + wy * wy) + depth);
  return dx * dx + dy * dy < reach * reach;
}

void SegmentCuts::leave_to_rivals(const SegmentPairs& pairs, LaneBits hit, Spans8& spans) const {
  const Linear& height = pairs.height;
  for_each_neighbour(
      pairs.row, hit, [&](int row) { return window_.rivals(row); },
      [&](int row, std::size_t k) { return window_.rival(row, k); },
      [&](LaneBits others, LaneBits have) {
        have &= may_be_nearer(pairs, others);
        if (!any(have)) return;
        const RelativeToRow there = relative_to_row(pairs.segments, others);
        Span8 nearer = strip_of(there.along, there.length);
        const Lanes tie = select(others < pairs.row, Lanes{}, broadcast(-1e-300));  // one of the two gets it
        nearer.keep({there.height.at0 - height.at0 + tie, there.height.at1 - height.at1 + tie});
        nearer.keep({-there.height.at0 - height.at0, -there.height.at1 - height.at1});
        spans.remove(only(have, nearer));
        for (const LaneBits end : {others, others + 1})
          spans.remove(only(have, nearer_to_node(pairs.segments, nodes(end), height)));
      });
}

Spans8 SegmentCuts::nearest_to_node(const SegmentPairs& pairs, const NodeLanes& nodes, LaneBits rows, LaneBits hit,
                                    const Span8& fan) const {
  Spans8 spans(fan, scratch_);
  const SlaveSegments& slaves = pairs.segments;
  for_each_neighbour(
      rows, hit, [&](int row) { return window_.rivals_of_node(row); },
      [&](int row, std::size_t k) { return window_.rival_of_node(row, k); },
      [&](LaneBits others, LaneBits have) {
        const RelativeToRow there = relative_to_row(slaves, others);
        const Span8 strip = only(have, strip_of(there.along, there.length)),
                    mine = nearer_to_node(slaves, nodes, there.height);
        const LaneBits some = mine.some();
        spans.remove({strip.low, select(some, min(strip.high, mine.low), strip.high)});
        spans.remove({select(some, max(strip.low, mine.high), broadcast(1)), strip.high});
        for (const LaneBits end : {others, others + 1}) {
          const NodeLanes rival = this->nodes(end);
          Span8 nearer = only(have, fan_of(slaves, rival));
          nearer.keep(squared_distance(slaves, nodes) - squared_distance(slaves, rival));
          spans.remove(nearer);
        }
      });
  return spans;
}

/// Vertex region that begins where the strips of both segments end, also by rounding.
Span8 SegmentCuts::fan_region(const SlaveSegments& slaves, const NodeLanes& nodes, LaneBits rows) const {
  LaneBits last = rows - 1;
  if (window_.count() == window_.outline_count()) last += (rows == 0) & window_.count();
  const LaneBits known = last >= 0;
  const RelativeToRow there = relative_to_row(slaves, known ? last : rows), here = relative_to_row(slaves, rows);
  const Linear past_last{there.along.at0 - there.length, there.along.at1 - there.length},
      before = FromNode(slaves, nodes).along(nodes.before_x, nodes.before_y);
  return fan_between(select(known, past_last, before), here.along);
}

void SegmentCuts::in_fans(const SegmentPairs& pairs, const NodeLanes& nodes, LaneBits rows, PackedParts& parts) const {
  const SlaveSegments& slaves = pairs.segments;
  const Span8 fan = fan_region(slaves, nodes, rows);
  const Lanes dx = slaves.x1 - slaves.x0, dy = slaves.y1 - slaves.y0, x0 = slaves.x0 - nodes.x,
              y0 = slaves.y0 - nodes.y;
  const Lanes square = dx * dx + dy * dy, inverse = 1.0 / square, foot = -(x0 * dx + y0 * dy) * inverse;
  const Lanes across = x0 * dy - y0 * dx, nearest = across * across * inverse;  // squared distance of the slave's line
  const auto half_chord = [&](double r) { return r == 0 ? Lanes{} : sqrt(max(r * r - nearest, Lanes{}) * inverse); };
  for (const bool inside : {true, false}) {
    const double radius = inside ? ranges_.deepest() : ranges_.reach;
    const LaneBits near =
        pairs.valid & fan.some() & (inside ? ~nodes.convex : nodes.convex) & (nearest < radius * radius);
    if (!any(near)) continue;
    const Spans8 spans = inside && window_.has_medial_neighbours() ? nearest_to_node(pairs, nodes, rows, near, fan)
                                                                   : Spans8(fan, scratch_);
    for (const GapRange& range : ranges_) {
      if (range.is_inside() != inside) continue;
      const Lanes outer = half_chord(inside ? -range.low : range.high),
                  inner = half_chord(inside ? -range.high : range.low);
      for (const Span8& span : spans) {
        parts.put(near, {max(span.low, foot - outer), min(span.high, foot - inner)}, range);
        parts.put(near, {max(span.low, foot + inner), min(span.high, foot + outer)}, range);
      }
    }
  }
}

}  // namespace pliant
