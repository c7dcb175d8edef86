#pragma once

#include <vector>

#include "core/vec2.hpp"
#include "reference/discretisation/body_distances.hpp"
#include "reference/discretisation/space.hpp"

namespace pliant::reference {

/// Moving least squares of a linear basis over scattered nodes (docs/method.md 2): cubic spline weights; a node's
/// radius is its distance to the `support`-th nearest other node, with distances through the body. Each position has
/// its own dense least squares problem, solved by orthogonalisation; gradients follow from differentiation of that
/// whole solution.
class MovingLeastSquares {
 public:
  /// `nodes` in lengths of about the node distance, so that rounding is the same for all sizes; the first
  /// `outline_count` are the body's outline. Throws InputError if there are too few nodes.
  MovingLeastSquares(Points nodes, int outline_count, int support);

  /// Values of all shape functions that do not vanish at x. Throws InputError if nodes do not determine them.
  Row values(const Vec2& x) const;
  /// Values and gradients by x, as an integration point without a weight.
  Point gradients(const Vec2& x) const;

 private:
  std::vector<int> neighbours(const Vec2& x) const;
  template <class Scalar>
  std::vector<Scalar> functions_at(const std::vector<int>& chosen, const Scalar& x, const Scalar& y) const;

  Points nodes_;
  BodyDistances distances_;
  std::vector<double> radius_;
};

}  // namespace pliant::reference
