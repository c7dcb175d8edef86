#pragma once

#include <limits>
#include <vector>

#include "core/vec2.hpp"

namespace pliant::reference {

/// First leg of a shortest path: it ends at `to`, where the path bends or ends; `rest` is the remaining length.
struct Leg {
  Vec2 to;
  double rest = 0;

  double length_from(const Vec2& x) const { return (to - x).norm() + rest; }
};

/// Shortest paths inside a closed outline (docs/method.md 2): straight if one end is visible from the other, else via
/// re-entrant corners that are visible from each other. Each visibility test checks every edge.
class BodyDistances {
 public:
  /// `outline`: counter-clockwise, in lengths of about the node distance.
  explicit BodyDistances(Points outline);

  /// First leg of the shortest path from `from` to `to`; its rest is infinite if the path is longer than `limit`.
  Leg first_leg(const Vec2& from, const Vec2& to, double limit = std::numeric_limits<double>::infinity()) const;

 private:
  bool sees(const Vec2& from, const Vec2& to) const;
  bool holds(const Vec2& x) const;

  Points outline_, corners_;                  ///< corners: re-entrant ones
  std::vector<std::vector<double>> between_;  ///< [corners][corners], lengths of paths
};

}  // namespace pliant::reference
