#include "geometry/clip.hpp"

namespace pliant {
namespace {

/// The part with sign x (p[axis] - limit) >= 0.
Points clipped_at(const Points& polygon, int axis, double limit, double sign) {
  Points result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[axis] - limit), db = sign * (b[axis] - limit);
    if (da >= 0) result.push_back(a);
    if ((da >= 0) != (db >= 0)) result.push_back(a + da / (da - db) * (b - a));
  }
  return result;
}

}  // namespace

Points clipped(const Points& polygon, const Vec2& low, const Vec2& high) {
  Points result = polygon;
  for (int axis = 0; axis < 2; ++axis) {
    result = clipped_at(result, axis, low[axis], 1);
    result = clipped_at(result, axis, high[axis], -1);
  }
  return result;
}

}  // namespace pliant
