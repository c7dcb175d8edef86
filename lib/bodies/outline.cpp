#include "bodies/outline.hpp"

#include <numeric>

#include "core/lanes.hpp"

namespace pliant {

OutlineShape make_outline_shape(const Points& points, double turn_shift) {
  OutlineShape shape;
  const int n = shape.count = static_cast<int>(points.size());
  shape.turn_shift = turn_shift;
  shape.points = points;
  std::vector<double> length;
  for (int i = 0; i < n; ++i)
    length.push_back((points[(i + 1) % n] + Vec2(i + 1 == n ? turn_shift : 0, 0) - points[i]).norm());
  for (int i = 0; i < n + lane_count; ++i)
    shape.tributary_length.push_back(0.5 * (length[(i + n - 1) % n] + length[i % n]));
  shape.spacing = std::accumulate(length.begin(), length.end(), 0.0) / n;
  return shape;
}

}  // namespace pliant
