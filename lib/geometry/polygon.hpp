#pragma once

#include <algorithm>

#include "core/vec2.hpp"

namespace pliant {

/// Length of a closed polygon, m.
double perimeter(const Points& polygon);

/// Whether x lies inside the closed polygon (even-odd rule; undecided on the outline itself).
bool is_inside(const Points& polygon, const Vec2& x);

/// Distance of x to the nearest point of the closed polygon, m; the polygon has no edge of length zero.
double distance_to_outline(const Points& polygon, const Vec2& x);

/// Whether a ray from x in the direction of x crosses the edge from a to b.
inline bool edge_is_crossed(const Vec2& a, const Vec2& b, const Vec2& x) {
  if ((a.y() > x.y()) == (b.y() > x.y())) return false;
  return x.x() < a.x() + (x.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
}

inline double square_distance_to_edge(const Vec2& a, const Vec2& b, const Vec2& x) {
  const Vec2 edge = b - a, r = x - a;
  const double xi = std::clamp(r.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (r - xi * edge).squaredNorm();
}

}  // namespace pliant
