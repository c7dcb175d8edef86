#pragma once

#include <array>

#include "core/elementary_functions.hpp"
#include "core/internal_variables.hpp"
#include "materials/elastic_constants.hpp"
#include "materials/respond.hpp"

namespace pliant {

/// Von Mises plasticity at finite strain in plane strain (docs/method.md 9): F = Fe Fp, Hencky's energy of the elastic
/// logarithmic strain e, Kirchhoff stress tau = K ln J 1 + 2 G dev e, associated flow with isotropic hardening,
///
///     q = sqrt(3/2) |dev tau| <= sigma(a) = yield + hardening a + (saturation - yield)(1 - exp(-saturation_rate a)),
///
/// and Perzyna's rate dependence q = sigma(a) (1 + t da/dt) of one time t. The exponential return (Weber and Anand
/// 1990, Comput. Methods Appl. Mech. Eng. 79, 173-202) scales dev e by r = 1 - 3 G da/q. With the inverse plastic
/// metric C = Cp^-1, b = F C F^T, A = tr b/2 and S(y) = sinh(y)/y, let h be half the difference of the principal
/// logarithms in the plane, and m their deviatoric mean. Then
///
///     b_new = c1 1 + c2 b,   c2 = exp(2 (r - 1) m) r S(2 r h)/S(2 h),   C_new = c1 (F^T F)^-1 + c2 C:
///
/// no eigenvector appears. Out of the plane F = 1, and det C = 1 gives C_zz, so that plastic flow keeps the volume.
template <class T>
struct VonMises {
  T mu, bulk;                                              ///< G, K, Pa
  T yield, hardening, saturation_excess, saturation_rate;  ///< Pa, Pa, saturation - yield in Pa, 1
  T viscoplastic_time;                                     ///< t, s
  T weight = T{} + 1.0;                                    ///< amount of material
  T flows = T{};                                           ///< 1 in a time increment; 0: internal variables are held
  T times = T{};                                           ///< t over the time increment

  static constexpr InternalVariable internal_variables[] = {{"inverse_plastic_metric_xx", 1},
                                                            {"inverse_plastic_metric_xy", 0},
                                                            {"inverse_plastic_metric_yy", 1},
                                                            {"equivalent_plastic_strain", 0}};
  using Record = std::array<T, 4>;
  static constexpr bool has_loss = true;

  static VonMises of(const Material& material) {
    const auto [mu, lambda] = lame_constants(material);
    const bool saturates = material.saturation > 0;
    return {mu,
            lambda + 2.0 / 3 * mu,
            material.yield,
            material.hardening,
            saturates ? material.saturation - material.yield : 0,
            saturates ? material.saturation_rate : 0,
            material.viscoplastic_time};
  }
  template <class W>
  VonMises weighted(W w) const {
    VonMises law = *this;
    law.weight = w * weight;
    return law;
  }
  VonMises over(double elapsed) const {
    if (elapsed == 0) return *this;
    VonMises law = *this;
    law.flows = T{} + 1.0, law.times = viscoplastic_time / elapsed;
    return law;
  }
  LameConstants<T> small_strains() const { return {mu, bulk - 2.0 / 3 * mu}; }

  Response<T> respond(const Tensor<T>& F, const Record& old, Record& now) const {
    const Elastic e(F, old);
    const T q = 2.0 * mu * square_root<T>(9.0 * e.mean * e.mean + 3.0 * e.h * e.h);
    const Yield before = yield_at(old[3]);
    T r = T{} + 1.0, loss{};
    now = old;
    const auto yields = is_less(before.stress, q) & is_less(T{}, flows);
    if (any(yields)) {
      const T trial = select(yields, q, before.stress + mu);  // another number above 0 where nothing flows
      const T flow = select(yields, plastic_strain(trial, old[3], before), T{}), after = yield_at(old[3] + flow).stress;
      r = 1.0 - 3.0 * mu * flow / trial;
      loss = flow * (0.5 * (before.stress + after) + times * flow * after);
      const T y = 2.0 * r * e.h, shrink = exponential<T>(2.0 * (r - 1.0) * e.mean), S = sinh_over<T>(y * y);
      const T c2 = shrink * r * S * e.slope * e.root;
      const T c1 = (shrink * e.root * square_root<T>(1.0 + y * y * S * S) - c2 * e.half_trace) / (e.J * e.J);
      now[0] = select(yields, c1 * (F.xy * F.xy + F.yy * F.yy) + c2 * old[0], old[0]);
      now[1] = select(yields, c2 * old[1] - c1 * (F.xx * F.xy + F.yx * F.yy), old[1]);
      now[2] = select(yields, c1 * (F.xx * F.xx + F.yx * F.yx) + c2 * old[2], old[2]);
      now[3] = old[3] + flow;
    }
    // tau F^-T with tau = p 1 + s b
    const T s = mu * r * e.slope, p = bulk * e.log_J + 2.0 * mu * r * e.mean - s * e.half_trace;
    const Tensor<T> tau{p + s * e.b_xx, s * e.b_xy, s * e.b_xy, p + s * e.b_yy};
    const T factor = weight / e.J;
    return {{factor * (tau.xx * F.yy - tau.xy * F.xy), factor * (tau.xy * F.xx - tau.xx * F.yx),
             factor * (tau.xy * F.yy - tau.yy * F.xy), factor * (tau.yy * F.xx - tau.xy * F.yx)},
            e.J,
            {},
            weight * loss};
  }

  T energy(const Tensor<T>& F, const Record& record) const {
    const Elastic e(F, record);
    return weight * (0.5 * bulk * e.log_J * e.log_J + mu * (6.0 * e.mean * e.mean + 2.0 * e.h * e.h));
  }
  double sigma_zz(const Tensor<double>& F, const Record& record) const {
    const Elastic e(F, record);
    return (bulk * e.log_J - 4.0 * mu * e.mean) / e.J;
  }

 private:
  struct Yield {
    T stress, slope;  ///< by the equivalent plastic strain, Pa
  };
  /// Yield stress; it does not fall below 0.
  Yield yield_at(T strain) const {
    Yield result{yield + hardening * strain, hardening};
    if (any(is_less(T{}, saturation_rate))) {
      const T left = saturation_excess * exponential<T>(-saturation_rate * strain);
      result.stress += saturation_excess - left, result.slope += saturation_rate * left;
    }
    const auto is_spent = is_less(result.stress, T{});
    return {select(is_spent, T{}, result.stress), select(is_spent, T{}, result.slope)};
  }

  /// Elastic strain with the plastic strain held.
  struct Elastic {
    T J, log_J, b_xx, b_xy, b_yy;
    T half_trace, root;  ///< A = tr b/2 and sqrt(det b) in the plane
    T mean, h;           ///< of the principal logarithms in the plane: mean of the deviatoric part, half difference
    T slope;             ///< h N = slope/2 (b - A 1), N the direction of dev b; slope sqrt(det b) = 1/S(2 h)

    Elastic(const Tensor<T>& F, const Record& record) {
      J = determinant(F);
      const T x = F.xx * record[0] + F.xy * record[1], y = F.xx * record[1] + F.xy * record[2],
              u = F.yx * record[0] + F.yy * record[1], v = F.yx * record[1] + F.yy * record[2];
      b_xx = x * F.xx + y * F.xy, b_xy = x * F.yx + y * F.yy, b_yy = u * F.yx + v * F.yy;
      const T det = record[0] * record[2] - record[1] * record[1];
      log_J = natural_log(J);
      mean = 1.0 / 6 * log_J + 0.25 * natural_log(det);
      half_trace = 0.5 * (b_xx + b_yy);
      root = J * square_root<T>(det);
      const T half_difference = 0.5 * (b_xx - b_yy), inverse_A = 1.0 / half_trace;
      const T z2 = (half_difference * half_difference + b_xy * b_xy) * inverse_A * inverse_A;
      const T ratio = artanh_over<T>(z2);
      h = 0.5 * square_root<T>(z2) * ratio;
      slope = ratio * inverse_A;
    }
  };

  /// Equivalent plastic strain x of a step: q - 3 G x = sigma(a + x)(1 + times x), by Newton's method from x = 0 on.
  /// The residual before the last iteration is below `tolerance` times q, and its square is the order of the error.
  T plastic_strain(T q, T a, Yield at) const {
    constexpr int most_iterations = 30;
    constexpr double tolerance = 1e-9;
    T x{};
    for (int i = 0; i < most_iterations; ++i) {
      const T viscous = 1.0 + times * x, residual = q - 3.0 * mu * x - at.stress * viscous;
      x += residual / (3.0 * mu + at.slope * viscous + at.stress * times);
      if (!any(is_less(tolerance * tolerance * q * q, residual * residual))) break;
      at = yield_at(a + x);
    }
    return x;
  }
};

}  // namespace pliant
