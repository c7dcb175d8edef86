#include "geometry/polygon_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pliant {

namespace {

/// Over the square of the extent: below that rounding decides which way a polygon turns.
constexpr double least_area = 1e-12;

int side(const Vec2& a, const Vec2& b, const Vec2& p) {
  const double z = cross(b - a, p - a);
  return (z > 0) - (z < 0);
}

bool boxes_apart(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return (a.cwiseMax(b).array() < c.cwiseMin(d).array()).any() || (c.cwiseMax(d).array() < a.cwiseMin(b).array()).any();
}

/// An edge that runs back over the one before it.
bool folds_back(const Vec2& before, const Vec2& corner, const Vec2& after) {
  return side(before, corner, after) == 0 && (corner - before).dot(after - corner) < 0;
}

}  // namespace

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  if (boxes_apart(a, b, c, d)) return false;
  return side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
}

PolygonDefect polygon_defect(const Points& polygon) {
  const std::size_t n = polygon.size();
  const auto point = [&](std::size_t i) -> const Vec2& { return polygon[i % n]; };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    if (point(i) == point(next)) return {fmt::format("points {} and {} coincide", i + 1, next + 1), next};
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (folds_back(point(i), point(i + 1), point(i + 2))) {
      return {fmt::format("edges {} and {} fold back", i + 1, (i + 1) % n + 1), (i + 1) % n};
    }
    for (std::size_t j = i + 2; j < n; ++j) {
      if ((j + 1) % n == i) continue;
      if (segments_meet(point(i), point(i + 1), point(j), point(j + 1))) {
        return {fmt::format("edges {} and {} cross or touch", i + 1, j + 1), j};
      }
    }
  }
  const double extent = largest_extent(polygon);
  if (!(std::abs(signed_area(polygon)) > least_area * extent * extent))
    return {"the points lie on one line, but for rounding", 0};
  return {};
}

std::vector<std::size_t> without_repeats(const Points& outline) {
  constexpr double digits = 1e-6;
  std::vector<std::size_t> kept;
  if (outline.empty()) return kept;
  Vec2 low = outline[0], high = outline[0];
  for (const Vec2& p : outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double least = digits * (high - low).norm();
  const auto repeats = [&](const Vec2& p, std::size_t other) { return (p - outline[other]).norm() <= least; };
  for (std::size_t i = 0; i < outline.size(); ++i)
    if (kept.empty() || !repeats(outline[i], kept.back())) kept.push_back(i);
  while (kept.size() > 1 && repeats(outline[kept.back()], kept.front())) kept.pop_back();
  return kept;
}

PolygonProperties polygon_properties(const Points& polygon) {
  PolygonProperties result;
  if (polygon.size() < 3) return result;
  // Relative to the first corner, so that a small polygon far from the origin loses no digits.
  const Vec2 origin = polygon[0];
  Vec2 first_moment(0, 0);
  double second_moment = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i] - origin, b = polygon[(i + 1) % polygon.size()] - origin;
    const double c = cross(a, b);
    result.area += c / 2;
    first_moment += c / 6 * (a + b);
    second_moment += c / 12 * (a.squaredNorm() + a.dot(b) + b.squaredNorm());
  }
  if (result.area == 0) return result;
  const Vec2 offset = first_moment / result.area;
  result.centroid = origin + offset;
  result.polar_moment = second_moment - result.area * offset.squaredNorm();
  return result;
}

bool is_inside(const Points& polygon, const Vec2& x) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
    if (edge_is_crossed(polygon[i], polygon[j], x)) inside = !inside;
  return inside;
}

double signed_area(const Points& polygon) {
  // About the first point: far from the origin, products of coordinates would cancel.
  double twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return 0.5 * twice;
}

double largest_extent(const Points& polygon) {
  double squared = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) squared = std::max(squared, (polygon[i] - polygon[j]).squaredNorm());
  }
  return std::sqrt(squared);
}

}  // namespace pliant
