#include "contact/slip.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

/// A place in the window: row, which may lie before or behind it, xi and the angle beyond an end.
struct Place {
  int row;
  double xi, angle;
};

double angle_of(double fan) { return std::asin(std::clamp(fan, -1.0, 1.0)); }

/// Way around the corner at a row's first node. Where the wedges open, outside a convex corner or inside a re-entrant one, the node runs around it
/// at the distance of the gap; where they close, the faces' ends are cut off on both sides.
double corner(const MasterSegment& before, const MasterSegment& after, double height, double gap) {
  const double sine = before.tangent_x * after.tangent_y - before.tangent_y * after.tangent_x;
  const double cosine = before.tangent_x * after.tangent_x + before.tangent_y * after.tangent_y;
  const double turn = std::atan2(sine, cosine);
  return height * turn > 0 ? gap * turn : 2 * height * std::tan(0.5 * turn);
}

/// A window of the whole outline is cut somewhere, and goes on there. In others, nodes move less than the skin between refreshes and stay on it.
const MasterSegment& at(const MasterWindow& window, int row) {
  const int n = window.count();
  return n == window.outline_count() ? window[row - turn_of(row, n) * n] : window[std::clamp(row, 0, n)];
}

double way_onward(const MasterWindow& window, const Place& from, const Place& to, double height, double gap) {
  double way =
      (1 - from.xi) * at(window, from.row).length + to.xi * at(window, to.row).length + gap * (to.angle - from.angle);
  for (int row = from.row + 1; row <= to.row; ++row) {
    way += corner(at(window, row - 1), at(window, row), height, gap);
    if (row < to.row) way += at(window, row).length;
  }
  return way;
}

}  // namespace

double way_between_segments(const MasterWindow& window, const Projection& p, int lane, double old_place) {
  const double old_number = std::floor(0.5 * (old_place + 0.5)), old_u = old_place - 2 * old_number;
  const double old_xi = std::clamp(old_u, 0.0, 1.0);
  double rows = old_number - p.number[lane];
  rows -= window.outline_count() * std::round(rows / window.outline_count());
  const Place now{static_cast<int>(p.row[lane]), p.xi[lane], angle_of(p.fan[lane])};
  const Place old{now.row + static_cast<int>(rows), old_xi, angle_of(fan_of(broadcast(old_u - old_xi))[0])};
  const double height = p.height[lane], gap = p.gap[lane];
  return old.row < now.row ? way_onward(window, old, now, height, gap) : -way_onward(window, now, old, height, gap);
}

}  // namespace pliant
