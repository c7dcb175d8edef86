#pragma once

#include "materials/respond.hpp"

namespace pliant {

/// Kelvin-Voigt damping (docs/method.md 3): second Piola stress S = 2 viscosity E_dot, P = F S, E_dot = sym(F^T F_dot),
/// which vanishes in rigid motions, in parallel with another law. It dissipates 2 viscosity E_dot : E_dot.
template <class Law, class T>
struct KelvinVoigt : Law {
  static constexpr bool has_rate = true;
  T viscosity;  ///< Pa s

  template <class W>
  KelvinVoigt weighted(W w) const {
    return {Law::weighted(w), w * viscosity};
  }
  KelvinVoigt over(double elapsed) const
    requires has_internal_variables<Law>
  {
    return {Law::over(elapsed), viscosity};
  }

  template <class Trial>
  [[gnu::always_inline]] Response<T> respond(const Trial& trial, const Tensor<T>& F, const Tensor<T>& rate,
                                             const Record<Law, T>& old, Record<Law, T>& now) const {
    const T xx = F.xx * rate.xx + F.yx * rate.yx, yy = F.xy * rate.xy + F.yy * rate.yy,
            xy = 0.5 * (F.xx * rate.xy + F.yx * rate.yy + F.xy * rate.xx + F.yy * rate.yx);  // E_dot
    const T factor = 2.0 * viscosity;
    Response<T> response = pliant::respond(static_cast<const Law&>(*this), trial, F, rate, old, now);
    response.P.xx += factor * (F.xx * xx + F.xy * xy);
    response.P.xy += factor * (F.xx * xy + F.xy * yy);
    response.P.yx += factor * (F.yx * xx + F.yy * xy);
    response.P.yy += factor * (F.yx * xy + F.yy * yy);
    response.power += factor * (xx * xx + 2.0 * xy * xy + yy * yy);
    return response;
  }
};

/// Law without elastic stress: a KelvinVoigt of it has viscous stress alone.
template <class T>
struct Unresisting {
  template <class W>
  Unresisting weighted(W) const {
    return {};
  }
  Response<T> respond(const Tensor<T>&) const { return {{T{}, T{}, T{}, T{}}, T{}}; }
};

}  // namespace pliant
