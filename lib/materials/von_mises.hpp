#pragma once

#include <array>
#include <limits>

#include "core/internal_variables.hpp"
#include "materials/elastic_constants.hpp"
#include "materials/hencky.hpp"

namespace pliant {

/// Von Mises plasticity at finite strain in plane strain (docs/method.md 9): Hencky's energy of the elastic logarithmic
/// strain e, Kirchhoff stress tau = K tr e 1 + 2 G dev e, associated flow with isotropic hardening,
///
///     q = sqrt(3/2) |dev tau| <= sigma(a) = yield + hardening a + (saturation - yield)(1 - exp(-saturation_rate a)),
///
/// and Perzyna's rate dependence q = sigma(a) (1 + t da/dt) of one time t. The return scales dev e by
/// 1 - s, s = 3 G da/q.
/// det C = 1 of the inverse plastic metric gives C_zz, so that plastic flow keeps the volume.
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
  static constexpr bool has_loss = true, flow_keeps_volume = true;

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

  /// Yield stress, Pa, which does not fall below 0, and what saturation will still add to it.
  struct Yield {
    T stress, left;
  };
  struct Trial {
    HenckyStrain<T> e;
    Yield yield;
    T q, inverse_q;
  };
  [[gnu::always_inline]] Trial trial(const Tensor<T>& F, const Record& old) const {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const HenckyStrain<T> e = elastic_strain(F, old);
    // Above 0, by the square of what rounding leaves of stresses of the order of G.
    const T q_squared = e.equivalent_stress_squared(mu) + epsilon * epsilon * mu * mu;
    const T inverse_q = inverse_square_root<T>(q_squared);
    return {e, yield_at(old[3]), q_squared * inverse_q, inverse_q};
  }

  [[gnu::always_inline]] Response<T> respond(const Trial& trial, const Tensor<T>& F, const Record& old,
                                             Record& now) const {
    const auto& [e, before, q, inverse_q] = trial;
    T shear = mu, loss{};
    now = old;
    const auto yields = both(is_less<T>(before.stress, q), is_less(T{}, flows));
    if (any(yields)) {
      const T flow = plastic_strain(select(yields, q, before.stress), before), fall = 3.0 * mu * flow;
      const T s = fall * inverse_q, now_q = q - fall;  // now_q: the yield stress without a rate
      loss = 0.5 * flow * (before.stress + now_q);
      if (is_viscous()) loss += 0.5 * flow * (now_q - now_q / (1.0 + times * flow));
      const PlaneMetric<T> metric = e.returned(F, {old[0], old[1], old[2]}, s, T{});
      now = {metric.xx, metric.xy, metric.yy, old[3] + flow};
      shear -= s * mu;
    }
    return {e.piola(F, weight * bulk * e.volume, weight * shear), e.J, T{}, weight * loss};
  }
  Response<T> respond(const Tensor<T>& F, const Record& old, Record& now) const {
    return respond(trial(F, old), F, old, now);
  }

  T energy(const Tensor<T>& F, const Record& record) const {
    const HenckyStrain<T> e = elastic_strain(F, record);
    return weight * (0.5 * bulk * e.volume * e.volume + mu * e.deviator_squared());
  }
  double sigma_zz(const Tensor<double>& F, const Record& record) const {
    const HenckyStrain<double> e = elastic_strain(F, record);
    return (bulk * e.volume - 4.0 * mu * e.mean) / e.J;
  }

 private:
  [[gnu::always_inline]] static HenckyStrain<T> elastic_strain(const Tensor<T>& F, const Record& record) {
    return {F, {record[0], record[1], record[2]}, T{} + 1.0};
  }

  bool is_viscous() const { return any(is_less(T{}, times)); }
  bool saturates() const { return any(is_less(T{}, saturation_rate)); }

  Yield yield_at(T strain) const {
    T left{};
    if (saturates()) left = saturation_excess * exponential<T>(-saturation_rate * strain);
    return not_negative({yield + hardening * strain + (saturation_excess - left), left});
  }
  /// The same, by x further on.
  Yield further(const Yield& from, T x) const {
    T left{};
    if (saturates()) left = from.left * exponential_of_small<T>(-saturation_rate * x);
    return not_negative({from.stress + hardening * x + (from.left - left), left});
  }
  static Yield not_negative(const Yield& at) { return {select(is_less(at.stress, T{}), T{}, at.stress), at.left}; }
  /// Derivative of the yield stress by the strain.
  T slope(const Yield& at) const { return select(is_less(T{}, at.stress), hardening + saturation_rate * at.left, T{}); }

  /// Equivalent plastic strain x of a step: q - 3 G x = sigma(a + x)(1 + times x). Residuals below `tolerance` times q
  /// are rounding.
  [[gnu::always_inline]] T plastic_strain(T q, const Yield& before) const {
    constexpr int most_iterations = 30;
    constexpr double tolerance = 1e-16;
    const auto is_small = [&](T residual) { return !any(is_less(tolerance * tolerance * q * q, residual * residual)); };
    const T excess = q - before.stress;
    T inverse = 1.0 / derivative(before, T{}), x = excess * inverse;
    if (!is_viscous()) {
      // The inverse series of the excess in y to third order, exact without saturation. As share <= 1, the lowest order
      // of its residual is below share excess y^3/4.
      const T share = saturation_rate * before.left * inverse, y = saturation_rate * x;
      if (is_small(0.25 * share * excess * (y * y * y)))
        return x * (1.0 + 0.5 * share * y * (1.0 + y * (share - 1.0 / 3)));
    }
    // Newton's method; without a rate from below, as sigma is concave. Its last iteration takes the
    // reciprocal derivative of the one before, with one Newton step.
    for (int i = 0; i < most_iterations; ++i) {
      const Yield at = further(before, x);
      const T residual = q - 3.0 * mu * x - at.stress * (1.0 + times * x), slope = derivative(at, x);
      const T change = 1.0 - slope * inverse;
      if (is_small(residual * change * change)) return x + residual * (inverse + inverse * change);
      inverse = 1.0 / slope;
      x += residual * inverse;
    }
    return x;
  }
  /// Of 3 G x + sigma(1 + times x) by x.
  T derivative(const Yield& at, T x) const { return 3.0 * mu + slope(at) * (1.0 + times * x) + at.stress * times; }
};

}  // namespace pliant
