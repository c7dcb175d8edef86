#pragma once

#include "core/vec2.hpp"

namespace pliant {

/// Points sorted into square cells, so that queries near a position test only some of them.
class NodeGrid {
 public:
  NodeGrid(const Points& points, double cell);

  /// Numbers of all points in the cells within `radius` of x, ascending: some are further away, none nearer is missing.
  std::vector<int> near(const Vec2& x, double radius) const;

  /// Squared distance of x to its number-th nearest point (0: the nearest, x itself if it is one of them). There must
  /// be that many points.
  double square_distance_to_nearest(const Vec2& x, int number) const;

 private:
  int column_of(double x) const;
  int row_of(double y) const;

  Points points_;
  Vec2 low_{0, 0};
  double cell_ = 1;
  int columns_ = 1, rows_ = 1;
  std::vector<int> start_, entries_;  ///< [cells + 1], rows of the other; [points], cell by cell
};

/// Grid with about one point per cell.
NodeGrid make_node_grid(const Points& points);

}  // namespace pliant
