#pragma once

#include <cmath>

#include "materials/neo_hookean.hpp"

namespace pliant {

/// Neo-Hookean solid with one Maxwell branch in parallel, for any strain: linear evolution of a viscous strain after
/// Lubliner (1985, Mech. Res. Commun. 12, 93-99). In the branch, with C = F^T F and the inverse G of its viscous
/// right Cauchy-Green tensor,
///
///     psi = m/2 (tr(C G) - 3 - ln det(C G)),   S = m H,   H = G - C^-1,   dG/dt = -H / t,
///
/// so H' = -H / t - (C^-1)' : a step is exact if C^-1 is linear in time, and else of second order. It dissipates
/// m / (2 t) (tr A + tr A^-1 - 6) >= 0, A = C G = 1 + C H. Out of the plane C and G stay 1. In small strains the branch
/// is a spring of shear modulus m and a dashpot of viscosity m t in series.
template <class T>
struct NeoHookeanMaxwell {
  T mu, lambda;                                 ///< of the equilibrium part, Pa
  T branch;                                     ///< m, Pa
  T relaxation_time;                            ///< t, s
  T decay = T{} + 1.0, mean_decay = T{} + 1.0;  ///< exp(-dt/t), and its mean over the step; 1 if held

  static constexpr InternalVariable internal_variables[] = {{"overstrain_xx", 0},     {"overstrain_xy", 0},
                                                            {"overstrain_yy", 0},     {"inverse_metric_xx", 1},
                                                            {"inverse_metric_xy", 0}, {"inverse_metric_yy", 1}};
  using Record = std::array<T, 6>;  ///< H, and the C^-1 at the same time
  static constexpr bool has_loss = false;

  static NeoHookeanMaxwell of(const Material& material) {
    const auto [mu, lambda] = lame_constants(material);
    return {mu, lambda, material.branch_modulus, material.relaxation_time};
  }
  template <class W>
  NeoHookeanMaxwell weighted(W w) const {
    return {w * mu, w * lambda, w * branch, relaxation_time, decay, mean_decay};
  }
  NeoHookeanMaxwell over(double elapsed) const {
    if (elapsed == 0) return *this;
    const T periods = elapsed / relaxation_time;
    NeoHookeanMaxwell law = *this;
    law.decay = in_each_lane(periods, [](double x) { return std::exp(-x); });
    law.mean_decay = in_each_lane(periods, [](double x) { return -std::expm1(-x) / x; });
    return law;
  }
  LameConstants<T> small_strains() const { return {mu + branch, lambda}; }

  Response<T> respond(const Tensor<T>& F, const Record& old, Record& now) const {
    const T xx = F.xx * F.xx + F.yx * F.yx, xy = F.xx * F.xy + F.yx * F.yy, yy = F.xy * F.xy + F.yy * F.yy;
    Response<T> response = NeoHookean<T>{mu, lambda}.respond(F);
    const T inverse = 1.0 / (response.J * response.J);
    now[3] = yy * inverse, now[4] = -xy * inverse, now[5] = xx * inverse;
    for (int k = 0; k < 3; ++k) now[k] = decay * old[k] - mean_decay * (now[3 + k] - old[3 + k]);
    response.P.xx += branch * (F.xx * now[0] + F.xy * now[1]);
    response.P.xy += branch * (F.xx * now[1] + F.xy * now[2]);
    response.P.yx += branch * (F.yx * now[0] + F.yy * now[1]);
    response.P.yy += branch * (F.yx * now[1] + F.yy * now[2]);
    const auto [trace, det] = elastic_part(F, now);
    response.power = 0.5 * branch / relaxation_time * (trace * (1.0 + 1.0 / det) - 4.0);
    return response;
  }

  T energy(const Tensor<T>& F, const Record& record) const {
    const auto [trace, det] = elastic_part(F, record);
    return NeoHookean<T>{mu, lambda}.energy(F) + 0.5 * branch * (trace - 2.0 - natural_log(det));
  }
  double sigma_zz(const Tensor<double>& F) const { return NeoHookean<double>{mu, lambda}.sigma_zz(F); }

 private:
  struct Invariants {
    T trace, det;
  };
  /// In-plane invariants of A = 1 + C H.
  static Invariants elastic_part(const Tensor<T>& F, const Record& record) {
    const T xx = F.xx * F.xx + F.yx * F.yx, xy = F.xx * F.xy + F.yx * F.yy, yy = F.xy * F.xy + F.yy * F.yy;
    const T a = 1.0 + xx * record[0] + xy * record[1], b = xx * record[1] + xy * record[2],
            c = xy * record[0] + yy * record[1], d = 1.0 + xy * record[1] + yy * record[2];
    return {a + d, a * d - b * c};
  }
};

}  // namespace pliant
