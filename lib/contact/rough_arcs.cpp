#include "contact/rough_arcs.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

double longest_segment(const OutlineShape& shape, const double* x, const double* y) {
  double square = 0;
  for (int i = 0; i < shape.count; ++i) {
    const double dx = x[i + 1] - x[i], dy = y[i + 1] - y[i];
    square = std::max(square, dx * dx + dy * dy);
  }
  return std::sqrt(square);
}

Box inflated(Box box, double by) { return {box.x_min - by, box.x_max + by, box.y_min - by, box.y_max + by}; }

bool inside(const Box& box, const Vec2& p) {
  return p.x() >= box.x_min && p.x() <= box.x_max && p.y() >= box.y_min && p.y() <= box.y_max;
}

/// Finds the turns of a wall's outline that cover [x_min, x_max] of the target.
void find_turns(ContactSide& side, const Box& own, const Box& target) {
  side.first_turn = side.last_turn = 0;
  if (side.shape->turn_shift == 0) return;
  const double period = std::abs(side.shape->turn_shift);
  const int low = static_cast<int>(std::floor((target.x_min - own.x_max) / period));
  const int high = static_cast<int>(std::ceil((target.x_max - own.x_min) / period));
  const bool reversed = side.shape->turn_shift < 0;
  side.first_turn = reversed ? -high : low;
  side.last_turn = reversed ? -low : high;
}

/// Least and largest coordinate along d of the side's nodes inside a box; empty: least > largest.
std::pair<double, double> extent(const ContactSide& side, const Box& box, const Vec2& d) {
  std::pair<double, double> result{1e300, -1e300};
  for (int turn = side.first_turn; turn <= side.last_turn; ++turn)
    for (int i = 0; i < side.shape->count; ++i)
      if (const Vec2 p = side.point(turn, i); inside(box, p)) {
        result.first = std::min(result.first, p.dot(d));
        result.second = std::max(result.second, p.dot(d));
      }
  return result;
}

/// Nodes inside the box with a coordinate along d of at least `least`, as one arc.
Arc select_arc(const ContactSide& side, const Box& box, const Vec2& d, double least) {
  const int n = side.shape->count;
  if (side.shape->turn_shift == 0) {
    thread_local std::vector<char> flags;  // so that memory is allocated once
    flags.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
      const double x = side.x[i] + side.shift, y = side.y[i];
      flags[i] =
          (x >= box.x_min) & (x <= box.x_max) & (y >= box.y_min) & (y <= box.y_max) & (x * d.x() + y * d.y() >= least);
    }
    return covering_arc(flags);
  }
  int begin = 0, end = -1;
  for (int turn = side.first_turn; turn <= side.last_turn; ++turn)
    for (int i = 0; i < n; ++i) {
      const Vec2 p = side.point(turn, i);
      if (!inside(box, p) || p.dot(d) < least) continue;
      if (end < begin) begin = turn * n + i;
      end = turn * n + i;
    }
  return {begin, end - begin + 1};
}

Vec2 direction(const Model& model, const ContactPair& pair, const Box& a, const Box& b) {
  const double dy = b.y_min + b.y_max - a.y_min - a.y_max;
  if (model.bodies[pair.second].wall || model.bodies[pair.first].wall) return {0, dy > 0 ? 1.0 : -1.0};
  const Vec2 d(b.x_min + b.x_max - a.x_min - a.x_max, dy);
  return d.norm() > 0 ? d.normalized() : Vec2(1, 0);
}

}  // namespace

ContactSide make_side(const Model& model, const OutlineField& outlines, int body, double shift) {
  const OutlineShape& shape = model.outline_of(body);
  ContactSide side{
      &shape, &outlines.x[model.outline_offset[body]], &outlines.y[model.outline_offset[body]], shift, 0, 0, 0};
  side.longest_segment = longest_segment(shape, side.x, side.y);
  return side;
}

Arc covering_arc(const std::vector<char>& flags) {
  const int n = static_cast<int>(flags.size());
  int best_gap = 0, best_end = 0, gap = 0;
  for (int i = 0; i < 2 * n; ++i) {
    gap = flags[i < n ? i : i - n] ? 0 : gap + 1;
    if (gap > best_gap) best_gap = gap, best_end = i + 1;
  }
  if (best_gap >= n) return {};
  return {best_end % n, n - best_gap};
}

void find_rough_arcs(const Model& model, const ContactSide& a, ContactSide& b, Box box_a, Box box_b,
                     const ContactPair& pair, double margin, Arc (&arcs)[2]) {
  arcs[0] = arcs[1] = {};
  // One more segment, because that end of a touched segment which is beyond the plane may be the far one.
  const double reach_a = margin + a.longest_segment, reach_b = margin + b.longest_segment;
  find_turns(b, box_b, inflated(box_a, reach_b));
  const Box region_a = model.bodies[pair.second].wall ? Box{-1e300, 1e300, box_b.y_min - reach_a, box_b.y_max + reach_a}
                                                      : inflated(box_b, reach_a);
  const Box region_b = inflated(box_a, reach_b);
  const Vec2 d = direction(model, pair, box_a, box_b);
  const Box everywhere{-1e300, 1e300, -1e300, 1e300};
  const auto extent_a = extent(a, everywhere, d);
  const auto extent_b =
      extent(b, model.bodies[pair.second].wall ? inflated(region_b, b.longest_segment) : everywhere, d);
  if (extent_b.first > extent_b.second) return;
  arcs[0] = select_arc(a, region_a, d, extent_b.first - margin);
  arcs[1] = select_arc(b, region_b, -d, -(extent_a.second + margin));
}

}  // namespace pliant
