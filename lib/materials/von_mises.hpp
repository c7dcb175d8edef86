#pragma once

#include <array>

#include "core/internal_variables.hpp"
#include "materials/elastic_constants.hpp"
#include "materials/hencky.hpp"

namespace pliant {

/// Von Mises plasticity at finite strain in plane strain (docs/method.md 9): Hencky's energy of the elastic logarithmic
/// strain e, Kirchhoff stress tau = K tr e 1 + 2 G dev e, associated flow with isotropic hardening,
///
///     q = sqrt(3/2) |dev tau| <= sigma(a) = yield + hardening a + (saturation - yield)(1 - exp(-saturation_rate a)),
///
/// and Perzyna's rate dependence q = sigma(a) (1 + t da/dt) of one time t. The return scales dev e by r = 1 - 3 G da/q.
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

  Response<T> respond(const Tensor<T>& F, const Record& old, Record& now) const {
    const PlaneMetric<T> C{old[0], old[1], old[2]};
    const HenckyStrain<T> e = elastic_strain(F, old);
    const T q_squared = e.equivalent_stress_squared(mu);
    const Yield before = yield_at(old[3]);
    T r = T{} + 1.0, loss{};
    now = old;
    const auto yields = is_less<T>(before.stress * before.stress, q_squared) & is_less(T{}, flows);
    if (any(yields)) {
      // Where nothing flows, another stress above 0.
      const T square = select(yields, q_squared, before.stress * before.stress + mu * mu);
      const T inverse = inverse_square_root<T>(square), q = square * inverse;
      const T flow = select(yields, plastic_strain(q, before), T{});
      r = 1.0 - 3.0 * mu * flow * inverse;
      const T now_q = q - 3.0 * mu * flow;  // the yield stress without a rate
      loss = 0.5 * flow * (before.stress + now_q);
      if (is_viscous()) loss += 0.5 * flow * (now_q - now_q / (1.0 + times * flow));
      const PlaneMetric<T> metric = select_metric(yields, e.returned(F, C, r, T{}), C);
      now = {metric.xx, metric.xy, metric.yy, old[3] + flow};
    }
    return {e.piola(F, weight * bulk * e.volume, weight * mu * r), e.J, T{}, weight * loss};
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
  static HenckyStrain<T> elastic_strain(const Tensor<T>& F, const Record& record) {
    const T log_det = natural_log<T>(record[0] * record[2] - record[1] * record[1]);
    return {F, {record[0], record[1], record[2]}, log_det, -log_det};
  }

  bool is_viscous() const { return any(is_less(T{}, times)); }
  bool saturates() const { return any(is_less(T{}, saturation_rate)); }

  /// Yield stress, Pa, which does not fall below 0, and what saturation will still add to it.
  struct Yield {
    T stress, left;
  };
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

  /// Equivalent plastic strain x of a step: q - 3 G x = sigma(a + x)(1 + times x), by Newton's method from x = 0 on.
  /// The residual before the last iteration is below `tolerance` times q, and its square is the order of the error.
  /// Without saturation and rate the first iteration is exact.
  T plastic_strain(T q, const Yield& before) const {
    constexpr int most_iterations = 30;
    constexpr double tolerance = 1e-9;
    const bool is_linear = !saturates() && !is_viscous();
    Yield at = before;
    T x{};
    for (int i = 0; i < most_iterations; ++i) {
      const T viscous = 1.0 + times * x, residual = q - 3.0 * mu * x - at.stress * viscous;
      x += residual / (3.0 * mu + slope(at) * viscous + at.stress * times);
      if (is_linear || !any(is_less(tolerance * tolerance * q * q, residual * residual))) break;
      at = further(before, x);
    }
    return x;
  }
};

}  // namespace pliant
