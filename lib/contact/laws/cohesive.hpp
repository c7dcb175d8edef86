#pragma once

#include "contact/laws/traction.hpp"

namespace pliant {

/// Reversible cohesion (docs/method.md 4): p = -kn g up to g_c = strength/kn, then linear to zero at `reach`;
/// |tau| <= shear strength with the same taper. The energy is zero for separated surfaces, and less by the work of
/// separation for surfaces in contact.
struct Cohesive {
  static constexpr bool has_shear = true;
  static constexpr const char* name = "cohesive";
  double normal_stiffness = 0;  ///< kn, Pa/m
  double shear_stiffness = 0;   ///< kt, Pa/m
  double reach = 0;             ///< g_max, m; larger than strength / kn
  double strength = 0;          ///< sigma_c, Pa
  double shear_strength = 0;    ///< tau_c, Pa

  std::array<double, 2> kinks() const { return {strength / normal_stiffness, reach}; }
  Traction operator()(Lanes gap) const {
    const double critical_gap = strength / normal_stiffness;
    const double inverse_taper = 1 / (reach - critical_gap);
    const LaneBits elastic = gap < critical_gap;
    const Lanes remaining = max(reach - gap, Lanes{});
    const Lanes taper = select(elastic, broadcast(1), remaining * inverse_taper);
    const Lanes pressure = select(elastic, -normal_stiffness * gap, -strength * taper);
    const Lanes elastic_energy = 0.5 * (normal_stiffness * gap * gap - strength * reach);
    return {pressure, shear_strength * taper, select(elastic, elastic_energy, -0.5 * strength * remaining * taper)};
  }
};

}  // namespace pliant
