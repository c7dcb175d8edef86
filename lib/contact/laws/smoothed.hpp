#pragma once

#include "contact/laws/traction.hpp"

namespace pliant {

/// Law without tension whose pressure sets in smoothly (docs/method.md 4): kn x^2 / (2 width) over the first `width` of
/// the penetration x, then kn (x - width/2). Forces are then once continuously differentiable in the gap, and an
/// integrator of order 2 shows that order.
template <class Law>
struct Smoothed : Law {
  double width = 0;  ///< m

  std::array<double, 2> kinks() const { return {-width, 0}; }
  Traction operator()(Lanes gap) const {
    const Lanes depth = max(-gap, Lanes{}), start = min(depth, broadcast(width));
    // Evaluates the linear law at the gap of the same pressure; it has no reach.
    Traction traction = Law::operator()(start - depth - start * start * (0.5 / width));
    traction.energy = this->normal_stiffness *
                      (start * start * start * (1 / (6 * width)) + 0.5 * (depth - start) * (depth - start + width));
    return traction;
  }
};

}  // namespace pliant
