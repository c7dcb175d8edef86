#include "bodies/outline.hpp"

#include "core/lanes.hpp"

namespace pliant {

OutlineShape make_outline_shape(const Points& points, double turn_shift) {
  OutlineShape shape;
  const int n = shape.count = static_cast<int>(points.size());
  shape.turn_shift = turn_shift;
  shape.points = points;
  const int extended = n + lane_count;
  shape.segment_length.resize(extended);
  shape.tributary_length.resize(extended);
  shape.arc.resize(extended);
  const auto point = [&](int i) {
    const int turns = i / n;
    return Vec2(points[i % n] + Vec2(turn_shift * turns, 0));
  };
  for (int i = 0; i < extended; ++i) shape.segment_length[i] = (point(i + 1) - point(i)).norm();
  for (int i = 0; i < extended; ++i)
    shape.tributary_length[i] = 0.5 * (shape.segment_length[i] + shape.segment_length[(i + n - 1) % n]);
  for (int i = 1; i < extended; ++i) shape.arc[i] = shape.arc[i - 1] + shape.segment_length[i - 1];
  for (int i = 0; i < n; ++i) shape.perimeter += shape.segment_length[i];
  shape.spacing = shape.perimeter / n;
  return shape;
}

}  // namespace pliant
