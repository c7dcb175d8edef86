#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/mesh.hpp"

namespace pliant {

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

double perimeter(const Points& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) sum += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  return sum;
}

bool is_inside(const Points& polygon, const Vec2& x) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
    if (edge_is_crossed(polygon[i], polygon[j], x)) inside = !inside;
  return inside;
}

double distance_to_outline(const Points& polygon, const Vec2& x) {
  double least = (x - polygon[0]).squaredNorm();
  for (std::size_t i = 0; i < polygon.size(); ++i)
    least = std::min(least, square_distance_to_edge(polygon[i], polygon[(i + 1) % polygon.size()], x));
  return std::sqrt(least);
}

}  // namespace pliant
