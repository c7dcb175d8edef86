#pragma once

#include <vector>

#include "core/vec2.hpp"
#include "reference/discretisation/space.hpp"

namespace pliant::reference {

/// Moving least squares of a linear basis over scattered nodes (docs/method.md 2): cubic spline weights, a node's
/// radius its distance to the `support`-th nearest other node. Every place is a dense least squares problem of its own,
/// solved by orthogonalisation; gradients come from differentiating that whole solution.
class MovingLeastSquares {
 public:
  /// `nodes` in lengths of about the node distance: rounding is then the same for all sizes. Throws InputError when
  /// there are too few nodes.
  MovingLeastSquares(Points nodes, int support);

  /// Values of all shape functions that do not vanish at x. Throws InputError where nodes do not determine them.
  Row values(const Vec2& x) const;
  /// Their gradients by x as well, in an integration point without a weight.
  Point gradients(const Vec2& x) const;

 private:
  std::vector<int> neighbours(const Vec2& x) const;

  Points nodes_;
  std::vector<double> radius_;
};

}  // namespace pliant::reference
