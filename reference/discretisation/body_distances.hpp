#pragma once

#include <limits>
#include <vector>

#include "core/vec2.hpp"

namespace pliant::reference {

/// How a shortest path begins: at `to`, where it bends or ends, `rest` of its length is left.
struct Leg {
  Vec2 to;
  double rest = 0;

  double length_from(const Vec2& x) const { return (to - x).norm() + rest; }
};

/// Shortest paths inside a closed outline (docs/method.md 2): straight where one end sees the other, else by way of
/// re-entrant corners that see each other. Every sight is looked at edge by edge.
class BodyDistances {
 public:
  /// `outline`: counter-clockwise, in lengths of about the node distance.
  explicit BodyDistances(Points outline);

  /// The shortest path's first leg, from `from` to `to`; of infinite rest where the path is longer than `limit`.
  Leg first_leg(const Vec2& from, const Vec2& to, double limit = std::numeric_limits<double>::infinity()) const;

 private:
  bool sees(const Vec2& from, const Vec2& to) const;
  bool holds(const Vec2& x) const;

  Points outline_, corners_;                  ///< corners: the re-entrant ones
  std::vector<std::vector<double>> between_;  ///< [corners][corners], lengths of paths
};

}  // namespace pliant::reference
