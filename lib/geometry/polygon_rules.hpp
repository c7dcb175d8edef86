#pragma once

#include <string>

#include "core/vec2.hpp"

namespace pliant {

/// Whether two segments a b and c d share a point; touching counts.
bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

struct PolygonDefect {
  std::string text;       ///< such as "points 2 and 3 coincide", "edges 1 and 4 cross"; empty: there is none
  std::size_t point = 0;  ///< index of a point at the defect
};

/// Why a closed polygon cannot bound a body. In the text points and edges count from 1; edge i starts at point i. Time
/// O(points^2).
PolygonDefect polygon_defect(const Points& polygon);

/// Numbers of the points of a closed outline without those that repeat the one before, or at the end the first: nearer
/// to it than 1e-6 of the extent. Files often close outlines so, and have six digits.
std::vector<std::size_t> without_repeats(const Points& outline);

struct PolygonProperties {
  double area = 0;
  Vec2 centroid{0, 0};
  double polar_moment = 0;  ///< integral of |x - centroid|^2 over the polygon, m4
};

PolygonProperties polygon_properties(const Points& polygon);

/// Whether x lies inside the closed polygon (even-odd rule; undecided on the outline itself).
bool is_inside(const Points& polygon, const Vec2& x);

/// Whether a ray from x in the direction of x crosses the edge from a to b.
inline bool edge_is_crossed(const Vec2& a, const Vec2& b, const Vec2& x) {
  if ((a.y() > x.y()) == (b.y() > x.y())) return false;
  return x.x() < a.x() + (x.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
}

double signed_area(const Points& polygon);  ///< m2, positive for counter-clockwise

/// Largest distance of two points, m: the width of the body in its widest orientation.
double largest_extent(const Points& polygon);

}  // namespace pliant
