#pragma once

#include <optional>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// Support function of an outline: h(theta) = max over its points p of p . (cos theta, sin theta), m. A body is inside
/// a convex cell if its convex hull is, which h describes.
class SupportFunction {
 public:
  explicit SupportFunction(const Points& outline);
  double nearest(double theta) const;  ///< at the nearest of many tabulated directions
  double exact(double theta) const;

 private:
  static constexpr int directions = 720;
  Points outline_;
  std::vector<double> table_;  ///< [directions]
};

/// Largest copy of a body that fits into a convex cell.
struct CellFit {
  double scale = 0, angle = 0;  ///< rad
  Vec2 centre{0, 0};            ///< m
};

/// Largest scale at which a body, translated and rotated freely, fits into a convex polygon: the best of many angles,
/// and for each angle the exact solution of the linear programme max s, n_i . c + s h(theta_i - angle) <= b_i over the
/// cell's edges i.
CellFit largest_in_cell(const Points& cell, const SupportFunction& body);

/// Phases of a Fourier grain that follow a cell, rad, for n = 2 on, `count` of them: those of the cell's polar radius
/// about its centroid.
std::vector<double> phases_of_cell(const Points& cell, int count);

}  // namespace pliant
