#pragma once

#include "contact/laws/cohesive.hpp"

namespace pliant {

/// Bonds with damage D (METHOD 4). One potential, psi = kn min(g, 0)^2 / 2 + (1 - D) (kn max(g, 0)^2 + kt s^2) / 2, gives pressure and shear: so the
/// shear stiffness is kn / r^2 for strengths in the ratio r. With the opening delta = sqrt(max(g, 0)^2 + (s/r)^2) the energy release rate is
/// -dpsi/dD = kn delta^2 / 2. Along a growing opening D = g_max (delta - g_c) / (delta (g_max - g_c)) makes the traction fall in a straight line from
/// the strength at g_c = strength / kn to zero at g_max, which takes strength g_max / 2.
/// Above a threshold stress each growing stress p adds dD = rate (p - threshold) / (strength - threshold) dp, in shear with stresses times r.
/// The bond has no limit of slip but its damage. Where D = 1, at any time, the cohesive law is left with the residual strength, and friction.
struct CohesiveFatigue {
  static constexpr bool has_shear = true, has_damage = true;
  static constexpr const char* name = "cohesive-fatigue";
  double normal_stiffness = 0;      ///< kn, Pa/m
  double shear_stiffness = 0;       ///< kn / r^2, Pa/m
  double reach = 0;                 ///< g_max, m; larger than strength / kn
  double strength = 0;              ///< Pa
  double shear_ratio = 1;           ///< r
  double residual_strength = 0;     ///< Pa
  double friction = 0;              ///< of broken contacts
  double threshold = 0;             ///< Pa
  double rate = 0, shear_rate = 0;  ///< 1/Pa
  double bond_gap = 0;              ///< gaps up to this are bonds at the start, m

  /// A bond at the last accepted step.
  struct Bond {
    Lanes damage, opening, slip;
  };

  /// Damage after a step to another opening and slip.
  Lanes damage(const Bond& bond, Lanes opening, Lanes slip) const {
    const double critical_gap = strength / normal_stiffness;
    const Lanes delta = sqrt(opening * opening + (shear_stiffness / normal_stiffness) * slip * slip);
    const Lanes safe = max(delta, broadcast(critical_gap));
    const Lanes by_opening = (reach / (reach - critical_gap)) * (1.0 - critical_gap / safe);
    const Lanes intact = 1.0 - bond.damage;
    const Lanes tension = normal_stiffness * intact, shear = (shear_stiffness * shear_ratio) * intact;
    const Lanes by_loads = rate * worn(tension * bond.opening, tension * opening) +
                           (shear_rate / shear_ratio) * worn(shear * abs(bond.slip), shear * abs(slip));
    return min(max(bond.damage + by_loads, by_opening), broadcast(1));
  }

  /// Tractions of what is broken.
  Traction broken(Lanes gap) const {
    const Cohesive residual{normal_stiffness, shear_stiffness, reach, residual_strength,
                            residual_strength / shear_ratio};
    Traction traction = residual(gap);
    traction.shear_limit += friction * max(traction.pressure, Lanes{});
    return traction;
  }

  /// Work that the bond's growing damage takes in a step, J/m2: the mean of the old and the new traction along the way, less what is stored, is
  /// exactly this.
  Lanes damage_work(const Bond& bond, Lanes damage, Lanes opening, Lanes slip) const {
    return 0.5 * (damage - bond.damage) *
           (normal_stiffness * bond.opening * opening + shear_stiffness * bond.slip * slip);
  }

 private:
  /// Integral of (p - threshold) / (strength - threshold) dp along a growing stress, Pa.
  Lanes worn(Lanes from, Lanes to) const {
    const Lanes low = max(from - threshold, Lanes{}), high = max(to - threshold, low);
    return (0.5 / (strength - threshold)) * (high * high - low * low);
  }
};

}  // namespace pliant
