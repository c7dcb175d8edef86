#pragma once

#include "core/lanes.hpp"
#include "materials/tensor.hpp"

namespace pliant {

/// Kelvin-Voigt damping (METHOD 3): second Piola stress S = 2 viscosity E_dot, P = F S, E_dot = sym(F^T F_dot), which vanishes in rigid motions.
struct KelvinVoigt {
  Lanes xx, xy, yy;  ///< E_dot, 1/s

  KelvinVoigt(const Tensor<Lanes>& F, const Tensor<Lanes>& rate)
      : xx(F.xx * rate.xx + F.yx * rate.yx),
        xy(0.5 * (F.xx * rate.xy + F.yx * rate.yy + F.xy * rate.xx + F.yy * rate.yx)),
        yy(F.xy * rate.xy + F.yy * rate.yy) {}

  /// E_dot : E_dot; times 2 viscosity the power dissipated per reference volume.
  Lanes square() const { return xx * xx + 2.0 * xy * xy + yy * yy; }

  /// P for `factor` = 2 viscosity.
  Tensor<Lanes> stress(const Tensor<Lanes>& F, Lanes factor) const {
    return {factor * (F.xx * xx + F.xy * xy), factor * (F.xx * xy + F.xy * yy), factor * (F.yx * xx + F.yy * xy),
            factor * (F.yx * xy + F.yy * yy)};
  }
};

}  // namespace pliant
