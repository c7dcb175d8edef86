#include "contact/slip.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

/// A point along the window: row, which may be outside the window, xi and the angle beyond an end.
struct Place {
  int row;
  double xi, angle;
};

/// Distances of a node from the master, m: height over a segment's line, and gap.
struct Distances {
  double height, gap;
};

/// Faces with a smaller cosine between their tangents, which is a turn of over 120 degrees, are flanks of a fold.
constexpr double folded = -0.5;

double angle_of(double fan) { return std::asin(std::clamp(fan, -1.0, 1.0)); }

/// Path length around the corner at a row's first node, for a node at a height over its row and at a gap. Outside a
/// convex corner or inside a re-entrant one wedges open, and the node moves around the corner at the distance of the
/// gap. Elsewhere wedges close, and the ends of both faces are cut off.
double corner(const MasterSegment& before, const MasterSegment& after, double height, double gap) {
  const double sine = before.tangent_x * after.tangent_y - before.tangent_y * after.tangent_x;
  const double cosine = before.tangent_x * after.tangent_x + before.tangent_y * after.tangent_y;
  const double turn = std::atan2(sine, cosine);
  return height * turn > 0 ? gap * turn : 2 * height * std::tan(0.5 * turn);
}

/// Segment of a row. A window of the whole outline continues cyclically beyond its ends. In other windows nodes stay on
/// the window, because they move less than the skin between rebuilds.
MasterSegment at(const MasterWindow& window, int row) {
  const int n = window.count();
  return n == window.outline_count() ? window[row - turn_of(row, n) * n] : window[std::clamp(row, 0, n)];
}

double distance_onward(const MasterWindow& window, const Place& from, const Place& to, double height, double gap) {
  double distance = (1 - from.xi) * at(window, from.row).mean_length + to.xi * at(window, to.row).mean_length +
                    gap * (to.angle - from.angle);
  for (int row = from.row + 1; row <= to.row; ++row) {
    distance += corner(at(window, row - 1), at(window, row), height, gap);
    if (row < to.row) distance += at(window, row).mean_length;
  }
  return distance;
}

/// Position of a node, and the tangent along which its shear acts there.
struct Stand {
  Vec2 position, tangent;
};

Stand stand(const MasterSegment& segment, const Place& place, double gap) {
  const Vec2 along(segment.tangent_x, segment.tangent_y), out(segment.tangent_y, -segment.tangent_x);
  const Vec2 normal = std::cos(place.angle) * out + std::sin(place.angle) * along;
  return {Vec2(segment.x, segment.y) + place.xi * segment.length * along + gap * normal, Vec2(-normal.y(), normal.x())};
}

/// Displacement at the mean gap along the mean of both tangents, on which a constant shear does work. From flank to
/// flank of a fold a node does not go around its bottom.
double across_fold(const MasterWindow& window, const Place& from, const Place& to, double gap) {
  const Stand old = stand(at(window, from.row), from, gap), now = stand(at(window, to.row), to, gap);
  const int n = window.count(), turn = n == window.outline_count() ? turn_of(from.row, n) : 0;
  const Vec2 period(window[n].x - window[0].x, window[n].y - window[0].y);  // 0 around a closed outline
  return 0.5 * (now.tangent + old.tangent).dot(now.position - old.position - turn * period);
}

bool are_folded(const MasterSegment& a, const MasterSegment& b) {
  return a.tangent_x * b.tangent_x + a.tangent_y * b.tangent_y < folded;
}

/// Distances of a slave node at the start of the step, from the row's segment then.
Distances former_distances(const FormerPlaces& from, int lane, const Place& place) {
  const PairView& view = from.view;
  const auto find = [&](int side, int index) -> Vec2 {
    const OutlineShape& outline = view.model.outline_of(view.body(side));
    const int turn = turn_of(index, outline.count), offset = view.model.outline_offset[view.body(side)];
    return view.before->at(offset + index - turn * outline.count) + view.image_of(*view.before, side) +
           Vec2(turn * outline.turn_shift, 0);
  };
  const int slave = from.pass.slave_side, segment = view.contact_pair.window[1 - slave].begin + place.row;
  const Vec2 a = find(1 - slave, segment), b = find(1 - slave, segment + 1), along = (b - a).normalized();
  const Vec2 beside = find(slave, from.pass.nodes.begin + from.first + lane) - a;
  const double height = beside.x() * along.y() - beside.y() * along.x();
  const double distance = (beside - place.xi * (b - a)).norm();
  return {height, place.angle == 0 ? height : std::copysign(distance, height)};
}

}  // namespace

double distance_along(const MasterWindow& window, const Projection& p, int lane, const FormerPlaces& from) {
  const double old_place = from.place[lane];
  const double old_number = std::floor(0.5 * (old_place + 0.5)), old_u = old_place - 2 * old_number;
  const double old_xi = std::clamp(old_u, 0.0, 1.0);
  double rows = old_number - p.number[lane];
  rows -= window.outline_count() * std::round(rows / window.outline_count());
  const Place now{static_cast<int>(p.row[lane]), p.xi[lane], angle_of(p.sine_beyond[lane])};
  const Place old{now.row + static_cast<int>(rows), old_xi, angle_of(fan_of(broadcast(old_u - old_xi))[0])};
  const Distances present{p.height[lane], p.gap[lane]},
      former = from.view.before ? former_distances(from, lane, old) : present;
  const double height = 0.5 * (former.height + present.height), gap = 0.5 * (former.gap + present.gap);
  if (old.row == now.row)
    return at(window, now.row).mean_length * (now.xi - old.xi) + gap * std::sin(now.angle - old.angle);
  if (are_folded(at(window, old.row), at(window, now.row))) return across_fold(window, old, now, gap);
  return old.row < now.row ? distance_onward(window, old, now, height, gap)
                           : -distance_onward(window, now, old, height, gap);
}

}  // namespace pliant
