#include "geometry/curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.hpp"
#include "geometry/polygon_rules.hpp"

namespace pliant {
namespace {

using std::numbers::pi;

/// The turn from one edge to the next at each corner, rad; positive where the polygon is convex.
std::vector<double> corner_turns(const Points& polygon) {
  const std::size_t n = polygon.size();
  std::vector<double> turns;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 before = polygon[i] - polygon[(i + n - 1) % n], after = polygon[(i + 1) % n] - polygon[i];
    turns.push_back(std::atan2(cross(before, after), before.dot(after)));
  }
  return turns;
}

/// What a rounded corner takes from each of its edges, over the radius.
double tangent_length(double turn) { return std::tan(std::abs(turn) / 2); }

/// Arcs that use up an edge end where the next begins.
Points without_repetitions(const Points& points) {
  Points distinct;
  const double extent = largest_extent(points);
  for (const Vec2& p : points)
    if (distinct.empty() || (p - distinct.back()).norm() > 1e-9 * extent) distinct.push_back(p);
  while (distinct.size() > 1 && (distinct.front() - distinct.back()).norm() <= 1e-9 * extent) distinct.pop_back();
  return distinct;
}

}  // namespace

Points regular_polygon(int sides, double diameter) {
  Points points;
  for (int k = 0; k < sides; ++k)
    points.emplace_back(diameter / 2 * std::cos(2 * pi * k / sides), diameter / 2 * std::sin(2 * pi * k / sides));
  return points;
}

Points ellipse(double width, double height) {
  Points points;
  for (const Vec2& p : regular_polygon(curve_points, 2)) points.emplace_back(width / 2 * p.x(), height / 2 * p.y());
  return scaled_to_area(points, pi / 4 * width * height);
}

Points scaled_to_area(Points polygon, double area) {
  const double scale = std::sqrt(area / signed_area(polygon));
  for (Vec2& p : polygon) p *= scale;
  return polygon;
}

double largest_rounding(const Points& polygon) {
  const std::vector<double> turns = corner_turns(polygon);
  double largest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    const double taken = tangent_length(turns[i]) + tangent_length(turns[next]);
    largest = std::min(largest, (polygon[next] - polygon[i]).norm() / taken);
  }
  return largest;
}

Points rounded_polygon(const Points& polygon, double radius) {
  constexpr double margin = 1e-9;  // relative: radii and lengths are decimal numbers of the user
  if (radius > largest_rounding(polygon) * (1 + margin)) return {};
  const std::vector<double> turns = corner_turns(polygon);
  const std::size_t n = polygon.size();
  Points points;
  double area = signed_area(polygon);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 along = (polygon[i] - polygon[(i + n - 1) % n]).normalized();
    const double side = turns[i] > 0 ? 1 : -1;
    const Vec2 inward = side * Vec2(-along.y(), along.x());
    const Vec2 start = polygon[i] - radius * tangent_length(turns[i]) * along, centre = start + radius * inward;
    const int steps = std::max(1, static_cast<int>(std::ceil(curve_points * std::abs(turns[i]) / (2 * pi))));
    for (int k = 0; k <= steps; ++k) {
      const double angle = std::abs(turns[i]) * k / steps;
      points.push_back(centre + radius * (std::sin(angle) * along - std::cos(angle) * inward));
    }
    // The corner between the tangents, less the sector: added where the polygon is concave.
    area -= side * radius * radius * (tangent_length(turns[i]) - std::abs(turns[i]) / 2);
  }
  return scaled_to_area(without_repetitions(points), area);
}

Points fourier_grain(double diameter, const std::vector<double>& descriptors, std::int64_t seed) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  std::vector<double> phases;
  for (std::size_t n = 0; n < descriptors.size(); ++n) phases.push_back(2 * pi * uniform_number(random));
  return fourier_grain(diameter, descriptors, phases);
}

Points fourier_grain(double diameter, const std::vector<double>& descriptors, const std::vector<double>& phases) {
  Points points;
  for (int k = 0; k < curve_points; ++k) {
    const double theta = 2 * pi * k / curve_points;
    double radius = 1;
    for (std::size_t i = 0; i < descriptors.size(); ++i)
      radius += descriptors[i] * std::cos(static_cast<double>(i + 2) * theta + phases[i]);
    if (!(radius > 0)) return {};
    points.emplace_back(radius * std::cos(theta), radius * std::sin(theta));
  }
  return scaled_to_area(points, pi / 4 * diameter * diameter);
}

}  // namespace pliant
