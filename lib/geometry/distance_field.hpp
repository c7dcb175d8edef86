#pragma once

#include <algorithm>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// Signed distance from a closed polygon, negative inside, tabulated on a square grid around it. The cost of a query
/// does not depend on the number of corners, convex or not. Interpolation is bilinear: the error is some percent of the
/// grid spacing, more in corners.
class DistanceField {
 public:
  explicit DistanceField(const Points& polygon);

  struct Sample {
    double distance = 0;  ///< m; beyond the grid: an upper bound
    Vec2 gradient{0, 0};  ///< 1 in length up to the table's error
  };
  Sample at(const Vec2& x) const;

 private:
  static constexpr int cells = 64;  // along the longer side
  double value(int column, int row) const { return values_[static_cast<std::size_t>(row * columns_ + column)]; }

  Vec2 origin_{0, 0};
  double spacing_ = 0;
  int columns_ = 0, rows_ = 0;  // of grid points
  std::vector<double> values_;
};

}  // namespace pliant
