#pragma once

#include "core/vec2.hpp"

namespace pliant {

/// Points in square cells, so that those near a place are found without a look at all.
class NodeGrid {
 public:
  NodeGrid(const Points& points, double cell);

  /// Numbers of all points in the cells within `radius` of x, ascending: some lie further away, none nearer is missing.
  std::vector<int> near(const Vec2& x, double radius) const;

  /// Square of the distance of x to its number-th nearest point (0: the nearest, x itself if it is one of them). There
  /// must be so many.
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

/// Cells of about one point each.
NodeGrid make_node_grid(const Points& points);

}  // namespace pliant
