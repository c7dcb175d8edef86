#pragma once

#include <array>

#include "core/internal_variables.hpp"
#include "materials/elastic_constants.hpp"
#include "materials/hencky.hpp"

namespace pliant {

/// Drucker-Prager plasticity at finite strain in plane strain (docs/method.md 9), with the elasticity of VonMises. With
/// the Kirchhoff stress tau = s 1 + dev tau and q = sqrt(3/2) |dev tau|,
///
///     q + friction s <= cohesion + hardening a,   flow along q + dilatancy s:
///
/// the equivalent plastic strain a grows by x, the deviatoric plastic strain along dev tau by x, the plastic volume by
/// dilatancy x. Where x would turn dev tau over, the stress returns to the apex q = 0, and the plastic volume grows by
/// friction x. The constants follow from angles and cohesion of Mohr and Coulomb such that both laws collapse at the
/// same stress in plane strain with associated flow (Drucker and Prager 1952, Q. Appl. Math. 10, 157-165).
template <class T>
struct DruckerPrager {
  T mu, bulk;                                  ///< G, K, Pa
  T friction, dilatancy, cohesion, hardening;  ///< 1, 1, Pa, Pa
  T weight = T{} + 1.0;                        ///< amount of material
  T flows = T{};                               ///< 1 in a time increment; 0: internal variables are held

  static constexpr InternalVariable internal_variables[] = {{"inverse_plastic_metric_xx", 1},
                                                            {"inverse_plastic_metric_xy", 0},
                                                            {"inverse_plastic_metric_yy", 1},
                                                            {"inverse_plastic_metric_zz", 1},
                                                            {"equivalent_plastic_strain", 0},
                                                            {"equivalent_stress", 0},
                                                            {"mean_stress", 0}};
  using Record = std::array<T, 7>;  ///< the stresses q and s, Pa, for the work of the next increment
  static constexpr bool has_loss = true;

  static DruckerPrager of(const Material& material) {
    const auto [mu, lambda] = lame_constants(material);
    const auto slope = [](double angle) {
      const double tangent = std::tan(angle);
      return std::sqrt(27.0) * tangent / std::sqrt(9 + 12 * tangent * tangent);
    };
    const double friction = slope(material.friction_angle);
    return {mu,
            lambda + 2.0 / 3 * mu,
            friction,
            slope(material.dilatancy_angle),
            friction / std::tan(material.friction_angle) * material.cohesion,
            friction / std::tan(material.friction_angle) * material.hardening};
  }
  template <class W>
  DruckerPrager weighted(W w) const {
    DruckerPrager law = *this;
    law.weight = w * weight;
    return law;
  }
  DruckerPrager over(double elapsed) const {
    DruckerPrager law = *this;
    law.flows = T{} + (elapsed == 0 ? 0.0 : 1.0);
    return law;
  }
  LameConstants<T> small_strains() const { return {mu, bulk - 2.0 / 3 * mu}; }

  struct Trial {
    HenckyStrain<T> e;
    T q;
  };
  [[gnu::always_inline]] Trial trial(const Tensor<T>& F, const Record& old) const {
    const HenckyStrain<T> e = elastic_strain(F, old);
    return {e, square_root<T>(e.equivalent_stress_squared(mu))};
  }

  [[gnu::always_inline]] Response<T> respond(const Trial& trial, const Tensor<T>& F, const Record& old,
                                             Record& now) const {
    const auto& [e, q] = trial;
    const T s = bulk * e.volume;
    const T excess = q + friction * s - cohesion - hardening * old[4];
    T fall{}, plastic_volume{}, flow{};
    now = old;
    const auto yields = both(is_less(T{}, excess), is_less(T{}, flows));
    if (any(yields)) {
      const T on_cone = excess / (3.0 * mu + bulk * friction * dilatancy + hardening);
      const T on_apex = (excess - q) / (bulk * friction * friction + hardening);
      const auto at_apex = is_less(q, 3.0 * mu * on_cone);
      flow = select(yields, select(at_apex, on_apex, on_cone), T{});
      fall = select(at_apex, T{} + 1.0, 3.0 * mu * flow / select(is_less(T{}, q), q, T{} + 1.0));
      fall = select(yields, fall, T{});
      plastic_volume = flow * select(at_apex, friction, dilatancy);
      const PlaneMetric<T> metric = e.returned(F, {old[0], old[1], old[2]}, fall, plastic_volume);
      const T log_zz = 2.0 / 3 * (e.volume - plastic_volume) - 4.0 * (1.0 - fall) * e.mean;
      now = {metric.xx, metric.xy, metric.yy, select(yields, exponential<T>(log_zz), old[3]), old[4] + flow};
    }
    const T pressure = s - bulk * plastic_volume;
    now[5] = (1.0 - fall) * q, now[6] = pressure;
    const T loss = 0.5 * ((old[5] + now[5]) * fall * q / (3.0 * mu) + (old[6] + now[6]) * plastic_volume);
    return {e.piola(F, weight * pressure, weight * mu * (1.0 - fall)), e.J, T{}, weight * loss};
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
    const PlaneMetric<T> C{record[0], record[1], record[2]};
    return {F, C, (C.xx * C.yy - C.xy * C.xy) * record[3]};
  }
};

}  // namespace pliant
