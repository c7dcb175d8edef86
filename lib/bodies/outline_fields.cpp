#include "bodies/outline_fields.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bodies/medial_neighbours.hpp"
#include "core/lanes.hpp"

namespace pliant {

namespace {

/// Vector from node i to the next.
Vec2 segment(const OutlineShape& shape, int i) {
  const int next = (i + 1) % shape.count;
  return shape.points[next] + Vec2(next == 0 ? shape.turn_shift : 0, 0) - shape.points[i];
}

std::vector<bool> find_corners(const OutlineShape& shape) {
  std::vector<bool> corner;
  for (int i = 0; i < shape.count; ++i) {
    const Vec2 before = segment(shape, (i + shape.count - 1) % shape.count), after = segment(shape, i);
    corner.push_back(std::atan2(cross(before, after), before.dot(after)) > corner_turn);
  }
  return std::find(corner.begin(), corner.end(), true) == corner.end() ? std::vector<bool>{} : corner;
}

}  // namespace

OutlineShape make_outline_shape(const Points& points, double turn_shift) {
  OutlineShape shape;
  const int n = shape.count = static_cast<int>(points.size());
  shape.turn_shift = turn_shift;
  shape.points = points;
  std::vector<double>& length = shape.segment_length;
  for (int i = 0; i < n; ++i) length.push_back(segment(shape, i).norm());
  for (int i = 0; i < n + lane_count; ++i)
    shape.tributary_length.push_back(0.5 * (length[(i + n - 1) % n] + length[i % n]));
  shape.spacing = std::accumulate(length.begin(), length.end(), 0.0) / n;
  shape.longest = *std::max_element(length.begin(), length.end());
  for (int i = 0; i < lane_count; ++i) length.push_back(length[i]);
  shape.corner = find_corners(shape);
  find_medial_neighbours(shape, 1.5 * shape.longest);  // detection depth: a segment and a skin
  return shape;
}

}  // namespace pliant
