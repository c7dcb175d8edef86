#pragma once

#include <string>
#include <vector>

#include "core/vec2.hpp"
#include "geometry/distance_field.hpp"
#include "geometry/placement.hpp"

namespace pliant {

/// Wall for the placement of grains beside it: a line y(x) that is periodic.
class WallProfile {
 public:
  /// of its points on asperities and lines, m
  WallProfile(const Wall& wall, double period, double spacing);

  const std::string& name() const { return name_; }
  /// y of the line's point furthest towards the grains, m.
  double extreme() const { return extreme_; }
  /// Whether some of its solid is between the levels of a region.
  bool reaches_into(const Strip& region) const { return side_ > 0 ? extreme_ > region.bottom : extreme_ < region.top; }
  /// Whether a circle is outside, beyond the whole line.
  bool clear_of(const Vec2& centre, double radius) const { return side_ * (centre.y() - extreme_) > radius; }
  /// Distance, negative in the solid, and its gradient: those of the line's tangent above or below the point.
  DistanceField::Sample at(const Vec2& x) const;
  /// Points of the line from the last before `left` to the first after `right`, from left to right.
  Points between(double left, double right) const;
  /// Whether the polygon overlaps the solid. Exact for this line.
  bool overlaps(const Points& polygon) const;

 private:
  /// Point number i, also beyond the period.
  Vec2 point(int i) const;
  /// Number of the last point at or before x.
  int last_before(double x) const;

  std::string name_;
  double period_, side_, extreme_;  ///< side: 1 with the grains above, else -1
  Points points_;                   ///< of one period, ascending in x
};

}  // namespace pliant
