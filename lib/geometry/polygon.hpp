#pragma once

#include <algorithm>

#include "core/vec2.hpp"
#include "geometry/polygon_rules.hpp"

namespace pliant {

/// Length of a closed polygon, m.
double perimeter(const Points& polygon);

/// Distance of x to the nearest point of the closed polygon, m; the polygon has no edge of length zero.
double distance_to_outline(const Points& polygon, const Vec2& x);

inline double square_distance_to_edge(const Vec2& a, const Vec2& b, const Vec2& x) {
  const Vec2 edge = b - a, r = x - a;
  const double xi = std::clamp(r.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (r - xi * edge).squaredNorm();
}

}  // namespace pliant
