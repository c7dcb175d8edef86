#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {

double perimeter(const Points& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) sum += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  return sum;
}

double distance_to_outline(const Points& polygon, const Vec2& x) {
  double least = (x - polygon[0]).squaredNorm();
  for (std::size_t i = 0; i < polygon.size(); ++i)
    least = std::min(least, square_distance_to_edge(polygon[i], polygon[(i + 1) % polygon.size()], x));
  return std::sqrt(least);
}

}  // namespace pliant
