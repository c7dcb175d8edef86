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

/// Path length around a corner with a turn, for a node at a height over the row's segment and at a gap. Outside a
/// convex corner or inside a re-entrant one wedges open, and the node moves around the corner at the distance of the
/// gap. Elsewhere wedges close, and the ends of both faces are cut off.
double corner(double turn, double height, double gap) {
  return height * turn > 0 ? gap * turn : 2 * height * std::tan(0.5 * turn);
}

double turn_between(const Vec2& before, const Vec2& after) {
  return std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
}

/// Segment of a row. A window of the whole outline continues cyclically beyond its ends. In other windows nodes stay on
/// the window, because they move less than the skin between rebuilds.
MasterSegment at(const MasterWindow& window, int row) {
  const int n = window.count();
  return n == window.outline_count() ? window[row - turn_of(row, n) * n] : window[std::clamp(row, 0, n)];
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

/// Outlines at the start of the step, if they are known.
class FormerOutlines {
 public:
  FormerOutlines(const FormerPlaces& from, int lane) : from_(from), lane_(lane) {}
  bool known() const { return from_.view.before; }

  /// Distances of the slave node from the segment of a row.
  Distances distances(const Place& place) const {
    const Vec2 a = master_node(place.row), b = master_node(place.row + 1), along = (b - a).normalized();
    const Vec2 beside = find(slave_side(), from_.pass.nodes.begin + from_.first + lane_) - a;
    const double height = beside.x() * along.y() - beside.y() * along.x();
    const double distance = (beside - place.xi * (b - a)).norm();
    return {height, place.angle == 0 ? height : std::copysign(distance, height)};
  }
  /// Turn of the outline at the first node of a row.
  double turn(int row) const {
    const Vec2 at = master_node(row);
    return turn_between(at - master_node(row - 1), master_node(row + 1) - at);
  }

 private:
  int slave_side() const { return from_.pass.slave_side; }
  Vec2 master_node(int row) const {
    return find(1 - slave_side(), from_.view.contact_pair.window[1 - slave_side()].begin + row);
  }
  Vec2 find(int side, int index) const {
    const PairView& view = from_.view;
    const OutlineShape& outline = view.model.outline_of(view.body(side));
    const int turns = turn_of(index, outline.count), offset = view.model.outline_offset[view.body(side)];
    return view.before->at(offset + index - turns * outline.count) + view.image_of(*view.before, side) +
           Vec2(turns * outline.turn_shift, 0);
  }

  const FormerPlaces& from_;
  int lane_;
};

double distance_onward(const MasterWindow& window, const FormerOutlines& former, const Place& from, const Place& to,
                       const Distances& mean) {
  double distance = (1 - from.xi) * at(window, from.row).mean_length + to.xi * at(window, to.row).mean_length +
                    mean.gap * (to.angle - from.angle);
  for (int row = from.row + 1; row <= to.row; ++row) {
    const MasterSegment before = at(window, row - 1), after = at(window, row);
    const double now = turn_between({before.tangent_x, before.tangent_y}, {after.tangent_x, after.tangent_y});
    distance += corner(former.known() ? 0.5 * (former.turn(row) + now) : now, mean.height, mean.gap);
    if (row < to.row) distance += at(window, row).mean_length;
  }
  return distance;
}

}  // namespace

double distance_along(const MasterWindow& window, const Projection& p, int lane, const FormerPlaces& from,
                      double place) {
  // Both ends from their surface coordinates: equal ones give 0.
  const auto decode = [&](double coordinate) {
    const double number = std::floor(0.5 * (coordinate + 0.5)), u = coordinate - 2 * number;
    double rows = number - p.number[lane];
    rows -= window.outline_count() * std::round(rows / window.outline_count());
    const double xi = std::clamp(u, 0.0, 1.0);
    return Place{static_cast<int>(p.row[lane]) + static_cast<int>(rows), xi, angle_of(fan_of(broadcast(u - xi))[0])};
  };
  const Place now = decode(place), old = decode(from.place[lane]);
  const FormerOutlines outlines(from, lane);
  const Distances present{p.height[lane], p.gap[lane]}, former = outlines.known() ? outlines.distances(old) : present;
  const Distances mean{0.5 * (former.height + present.height), 0.5 * (former.gap + present.gap)};
  if (old.row == now.row)
    return at(window, now.row).mean_length * (now.xi - old.xi) + mean.gap * std::sin(now.angle - old.angle);
  if (are_folded(at(window, old.row), at(window, now.row))) return across_fold(window, old, now, mean.gap);
  return old.row < now.row ? distance_onward(window, outlines, old, now, mean)
                           : -distance_onward(window, outlines, now, old, mean);
}

}  // namespace pliant
