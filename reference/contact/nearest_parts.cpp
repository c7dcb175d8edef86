#include "reference/contact/nearest_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace pliant::reference {
namespace {

/// c0 + c1 s + c2 s^2 along a piece.
struct Parabola {
  double c0 = 0, c1 = 0, c2 = 0;
};

void add_root(double c0, double c1, std::vector<double>& cuts) {
  if (c1 == 0) return;
  const double s = -c0 / c1;
  if (s > 0 && s < 1) cuts.push_back(s);
}

void add_roots(const Parabola& of, std::vector<double>& cuts) {
  const double half = of.c1 / 2, discriminant = half * half - of.c0 * of.c2;
  if (discriminant < 0) return;
  const double sum = half + std::copysign(std::sqrt(discriminant), half);
  add_root(sum, of.c2, cuts);
  add_root(of.c0, sum, cuts);
}

/// Distances to the master along one piece: linear to the lines of its segments, the root of a parabola to its nodes.
class Distances {
 public:
  Distances(const PresentOutline& master, const Stretch& stretch) : master_(master), stretch_(stretch) {}

  /// Signed height above the line of a segment.
  Parabola height(int segment) const {
    const Vec2 t = master_.tangent(segment), n(t.y(), -t.x());
    return {(stretch_.first - master_.node(segment)).dot(n), stretch_.along().dot(n), 0};
  }
  double height(int segment, const Vec2& point) const {
    const Vec2 t = master_.tangent(segment);
    return (point - master_.node(segment)).dot(Vec2(t.y(), -t.x()));
  }
  /// Coordinate from a node along a direction.
  Parabola along(int node, const Vec2& direction) const {
    return {(stretch_.first - master_.node(node)).dot(direction), stretch_.along().dot(direction), 0};
  }
  Parabola squared(int node) const {
    const Vec2 from = stretch_.first - master_.node(node), way = stretch_.along();
    return {from.squaredNorm(), 2 * from.dot(way), way.squaredNorm()};
  }

 private:
  const PresentOutline& master_;
  const Stretch& stretch_;
};

double distance_to(const PresentOutline& master, int segment, const Vec2& point) {
  const Vec2 a = master.node(segment), way = master.node(segment + 1) - a;
  const double share = std::clamp((point - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (point - a - share * way).norm();
}

/// Segments that can be nearest anywhere along the piece. Distances change by no more than the path, and are nowhere
/// larger than at one of its ends.
std::vector<int> possible(const PresentOutline& master, int first, int count, const Stretch& stretch) {
  const double half = stretch.along().norm() / 2;
  double bound = std::numeric_limits<double>::infinity();
  std::vector<double> middle;
  for (int i = first; i < first + count; ++i) {
    middle.push_back(distance_to(master, i, stretch.at(0.5)));
    bound = std::min(bound, std::max(distance_to(master, i, stretch.first), distance_to(master, i, stretch.second)));
  }
  std::vector<int> found;
  for (int i = 0; i < count; ++i)
    if (middle[static_cast<std::size_t>(i)] - half <= (1 + 1e-9) * bound) found.push_back(first + i);
  return found;
}

Nearby nearest(const PresentOutline& master, const std::vector<int>& segments, const Vec2& point) {
  int best = segments.front();
  double least = std::numeric_limits<double>::infinity();
  for (const int i : segments)
    if (const double distance = distance_to(master, i, point); distance < least) best = i, least = distance;
  const auto along = [&](int i) { return (point - master.node(i)).dot(master.tangent(i)); };
  const auto beside = [&](int i) { return along(i) >= 0 && along(i) <= master.length(i); };
  if (beside(best)) return {best, false};
  // Close to the normal of a node its distance and that to the other segment are equal.
  const int node = along(best) < 0 ? best : best + 1, other = along(best) < 0 ? best - 1 : best + 1;
  if (beside(other)) return {other, false};
  return {master.closed() && node == master.count() ? 0 : node, true};  // unique numbers
}

}  // namespace

bool is_outside(const PresentOutline& master, int node, const Vec2& point) {
  const Vec2 from = point - master.node(node), before = master.tangent(node - 1), after = master.tangent(node);
  const double over_before = from.dot(Vec2(before.y(), -before.x())),
               over_after = from.dot(Vec2(after.y(), -after.x()));
  return (std::abs(over_before) > std::abs(over_after) ? over_before : over_after) > 0;
}

namespace {

/// Whether the whole piece is outside by more than the reach.
bool is_apart(const PresentOutline& master, const std::vector<int>& segments, const Stretch& stretch, double reach) {
  const Vec2 middle = stretch.at(0.5);
  const Nearby at = nearest(master, segments, middle);
  const bool outside =
      at.at_node ? is_outside(master, at.segment, middle) : Distances(master, stretch).height(at.segment, middle) > 0;
  return outside && distance_to(master, at.segment, middle) > reach + stretch.along().norm() / 2;
}

/// All points where the nearest part may change: crossings of all distances, and ends of each segment's strip.
std::vector<double> all_cuts(const PresentOutline& master, const std::vector<int>& segments, const Stretch& stretch) {
  const Distances of(master, stretch);
  std::vector<double> cuts{0, 1};
  std::set<int> nodes;
  for (const int i : segments) nodes.insert(i), nodes.insert(i + 1);
  const auto cut = [&](const Parabola& line) { add_root(line.c0, line.c1, cuts); };
  for (const int i : segments)
    for (const int end : {i, i + 1}) cut(of.along(end, master.tangent(i)));
  for (const int i : segments) {
    const Parabola h = of.height(i);
    for (const int j : segments) {
      if (j <= i) continue;
      const Parabola other = of.height(j);
      add_root(h.c0 - other.c0, h.c1 - other.c1, cuts);
      add_root(h.c0 + other.c0, h.c1 + other.c1, cuts);
    }
    for (const int k : nodes) {
      const Parabola q = of.squared(k);
      add_roots({q.c0 - h.c0 * h.c0, q.c1 - 2 * h.c0 * h.c1, q.c2 - h.c1 * h.c1}, cuts);
    }
  }
  for (const int k : nodes)
    for (const int l : nodes)
      if (l > k) {
        const Parabola p = of.squared(k), q = of.squared(l);
        add_root(p.c0 - q.c0, p.c1 - q.c1, cuts);
      }
  return cuts;
}

/// Adds the cuts of a part, where the distance passes a level.
void add_levels(const PresentOutline& master, const Stretch& stretch, const Part& part, std::span<const double> levels,
                std::vector<double>& cuts) {
  const Distances of(master, stretch);
  const Parabola height = of.height(part.nearby.segment);
  const bool outside = is_outside(master, part.nearby.segment, stretch.at(part.middle()));
  for (const double level : levels)
    if (!part.nearby.at_node) {
      add_root(height.c0 - level, height.c1, cuts);
    } else if (level == 0) {
      // The piece may pass right through a node between collinear segments.
      const Parabola squared = of.squared(part.nearby.segment);
      add_root(squared.c1, 2 * squared.c2, cuts);
    } else if (outside == (level > 0)) {
      Parabola squared = of.squared(part.nearby.segment);
      squared.c0 -= level * level;
      add_roots(squared, cuts);
    }
}

}  // namespace

std::vector<Part> nearest_parts(const PresentOutline& master, int first, int count, const Stretch& stretch,
                                std::span<const double> levels, double reach) {
  const std::vector<int> segments = possible(master, first, count, stretch);
  if (is_apart(master, segments, stretch, reach)) return {};
  std::vector<double> cuts = all_cuts(master, segments, stretch);
  std::ranges::sort(cuts);
  std::vector<Part> whole;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    if (cuts[k + 1] <= cuts[k]) continue;
    const Nearby nearby = nearest(master, segments, stretch.at((cuts[k] + cuts[k + 1]) / 2));
    if (!whole.empty() && whole.back().nearby == nearby)
      whole.back().end = cuts[k + 1];
    else
      whole.push_back({cuts[k], cuts[k + 1], nearby});
  }
  std::vector<Part> parts;
  for (const Part& part : whole) {
    std::vector<double> ends;
    add_levels(master, stretch, part, levels, ends);
    std::erase_if(ends, [&](double s) { return s <= part.start || s >= part.end; });
    ends.push_back(part.end);
    std::ranges::sort(ends);
    double start = part.start;
    for (const double end : ends) {
      if (end > start) parts.push_back({start, end, part.nearby});
      start = end;
    }
  }
  return parts;
}

}  // namespace pliant::reference
