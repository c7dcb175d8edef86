#include "geometry/wall_profile.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/mesh.hpp"
#include "geometry/overlap.hpp"

namespace pliant {

WallProfile::WallProfile(const Wall& wall, double period, double spacing)
    : name_(wall.name),
      period_(period),
      side_(wall.solid == Wall::Solid::below ? 1 : -1),
      extreme_(wall.level),
      points_(wall_outline(wall, period, spacing)) {
  if (side_ > 0) std::reverse(points_.begin(), points_.end());
  extreme_ = points_[0].y();
  for (const Vec2& p : points_) extreme_ = side_ * std::max(side_ * extreme_, side_ * p.y());
}

Vec2 WallProfile::point(int i) const {
  const int count = static_cast<int>(points_.size()), turn = i >= 0 ? i / count : -((count - 1 - i) / count);
  return points_[i - turn * count] + Vec2(turn * period_, 0);
}

int WallProfile::last_before(double x) const {
  const double turn = std::floor((x - points_[0].x()) / period_), within = x - turn * period_;
  const auto next =
      std::upper_bound(points_.begin(), points_.end(), within, [](double at, const Vec2& p) { return at < p.x(); });
  return static_cast<int>(next - points_.begin()) - 1 + static_cast<int>(turn) * static_cast<int>(points_.size());
}

DistanceField::Sample WallProfile::at(const Vec2& x) const {
  const int i = last_before(x.x());
  const Vec2 from = point(i), along = (point(i + 1) - from).normalized();
  const Vec2 normal = side_ * Vec2(-along.y(), along.x());
  return {normal.dot(x - from), normal};
}

Points WallProfile::between(double left, double right) const {
  Points result;
  const int last = last_before(right) + 1;
  for (int i = last_before(left); i <= last; ++i) result.push_back(point(i));
  return result;
}

bool WallProfile::overlaps(const Points& polygon) const {
  Vec2 low = polygon[0], high = polygon[0];
  for (const Vec2& p : polygon) low = low.cwiseMin(p), high = high.cwiseMax(p);
  Points solid = between(low.x(), high.x());
  double depth = side_ > 0 ? low.y() : high.y();
  for (const Vec2& p : solid) depth = side_ * std::min(side_ * depth, side_ * p.y());
  depth -= side_ * (high - low).norm();
  const double left = solid.front().x(), right = solid.back().x();
  solid.emplace_back(right, depth);
  solid.emplace_back(left, depth);
  return polygons_overlap(polygon, solid);
}

}  // namespace pliant
