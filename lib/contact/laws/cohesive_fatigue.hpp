#pragma once

#include "contact/laws/cohesive.hpp"
#include "contact/laws/response.hpp"

namespace pliant {

/// Bonds with damage D (docs/method.md 4). Tractions and energy are 1 - D times those of an intact bond and D times
/// those of broken surfaces (Alfano and Sacco 2006, doi 10.1002/nme.1728). An intact bond has the energy
/// (kn g^2 + kt s^2) / 2, so the shear stiffness is kn / r^2 for strengths in the ratio r. Broken surfaces have the
/// cohesive law of the residual strength, and friction, whose elastic slip grows from the first step on. Both have one
/// stiffness: while slip grows, a bond never bears less than friction alone. The opening is
/// delta = sqrt(max(g, 0)^2 + (s/r)^2). Damage of an intact bond in tension releases kn delta^2 / 2. Along a growing
/// opening D = g_max (delta - g_c) / (delta (g_max - g_c)) makes its traction fall linearly from the strength at
/// g_c = strength / kn to zero at g_max, which takes strength g_max / 2. Above a threshold stress each growing stress p
/// adds dD = rate (p - threshold) / (strength - threshold) dp, in shear with stresses times r. The slip of a bond is
/// limited only by its damage, which grows only where that releases energy.
struct CohesiveFatigue {
  static constexpr bool has_shear = true;
  static constexpr const char* name = "cohesive-fatigue";
  /// Damage, 1: broken; opening max(g, 0), m; elastic slip of the broken share of a bond, m. The slip that all laws
  /// have is that of the bond, and after the bond has broken that of friction.
  static constexpr InternalVariable internal_variables[] = {{"damage", 1}, {"opening", 0}, {"friction_slip", 0}};
  double normal_stiffness = 0;      ///< kn, Pa/m
  double shear_stiffness = 0;       ///< kn / r^2, Pa/m
  double reach = 0;                 ///< g_max, m; larger than strength / kn
  double strength = 0;              ///< Pa
  double shear_ratio = 1;           ///< r
  double residual_strength = 0;     ///< Pa
  double friction = 0;              ///< of broken surfaces
  double threshold = 0;             ///< Pa
  double rate = 0, shear_rate = 0;  ///< 1/Pa
  double bond_gap = 0;              ///< gaps up to this are bonds at the start, m

  using Record = pliant::Record<CohesiveFatigue>;

  /// Tractions of broken surfaces.
  Traction operator()(Lanes gap) const {
    const Cohesive residual{normal_stiffness, shear_stiffness, reach, residual_strength,
                            residual_strength / shear_ratio};
    Traction traction = residual(gap);
    traction.shear_limit += friction * max(traction.pressure, Lanes{});
    return traction;
  }

  /// `broken`: tractions of broken surfaces.
  Contact respond(const GapAndSlip& at, const Traction& broken, Lanes old_slip, const Record& old, Record& now) const {
    const LaneBits bonded = old[0] < 1.0;
    const Lanes elastic = select(bonded, old[2], old_slip);
    now = {broadcast(1), select(at.projects, max(at.gap, Lanes{}), Lanes{}), Lanes{}};
    Contact c{broken.pressure, {}, broken.energy, {}, {}};
    slide(*this, broken, at.touching, elastic, elastic + at.moved, c);
    if (any(bonded)) hold(at, {old[0], old[1], old_slip}, bonded, elastic, c, now);
    return c;
  }

  Lanes set_free(Lanes old_slip, const Record& old) const {
    const LaneBits bonded = old[0] < 1.0;
    const Lanes elastic = select(bonded, old[2], old_slip);
    const Lanes bond = damage_work({old[0], old[1], old_slip}, broadcast(1), old[1], old_slip);
    return (0.5 * shear_stiffness) * old[0] * elastic * elastic + bond;
  }

  double start_reach() const { return bond_gap; }
  Record at_start(Lanes gap, LaneBits projects) const {
    const LaneBits near = projects & (gap <= bond_gap);
    return {select(near, Lanes{}, broadcast(1)), select(near, max(gap, Lanes{}), Lanes{}), Lanes{}};
  }

 private:
  /// Bond at the last accepted step.
  struct Bond {
    Lanes damage, opening, slip;
  };

  /// Adds the intact share of bonds to `c`, the response of the broken share, whose elastic slip was `elastic`. Bonds
  /// of nodes that no longer project onto the master break.
  void hold(const GapAndSlip& at, const Bond& bond, LaneBits bonded, Lanes elastic, Contact& c, Record& now) const {
    const Lanes opening = select(at.projects, max(at.gap, Lanes{}), bond.opening), slip = bond.slip + at.moved;
    const Lanes damage = select(bonded & at.projects, this->damage(bond, opening, slip, c.slip), broadcast(1));
    const Lanes whole = 1.0 - damage, grown = damage - bond.damage, depth = min(at.gap, Lanes{});
    // Work of the mean of old and new tractions in the step, less the stored energy: of the intact share, of friction,
    // of residual cohesion.
    const Lanes slid = elastic + at.moved - c.slip;
    c.slip_work =
        damage_work(bond, damage, opening, slip) +
        (0.5 * shear_stiffness) * ((bond.damage * elastic + damage * c.slip) * slid - grown * elastic * c.slip);
    if (residual_strength > 0) {
      const Lanes energies = (*this)(bond.opening).energy + (*this)(opening).energy;
      c.slip_work -= select(at.projects, 0.5 * grown * energies, Lanes{});
    }
    c.pressure = damage * c.pressure - whole * (normal_stiffness * (depth + opening));
    c.shear = damage * c.shear - whole * (shear_stiffness * slip);
    c.energy = damage * c.energy +
               whole * (0.5 * (normal_stiffness * (depth * depth + opening * opening) + shear_stiffness * slip * slip));
    const LaneBits held = damage < 1.0;
    now[0] = damage, now[2] = select(held, c.slip, Lanes{});
    c.slip = select(held, slip, c.slip);
  }

  /// Damage after a step to another opening, slip, and elastic slip of the broken share. It grows only where that
  /// releases energy: not if friction, after a reversal under more pressure, stores more than the bond.
  Lanes damage(const Bond& bond, Lanes opening, Lanes slip, Lanes elastic) const {
    const double critical_gap = strength / normal_stiffness;
    const Lanes delta = sqrt(opening * opening + (shear_stiffness / normal_stiffness) * slip * slip);
    const Lanes safe = max(delta, broadcast(critical_gap));
    const Lanes by_opening = (reach / (reach - critical_gap)) * (1.0 - critical_gap / safe);
    const Lanes intact = 1.0 - bond.damage;
    const Lanes tension = normal_stiffness * intact, shear = (shear_stiffness * shear_ratio) * intact;
    const Lanes by_loads = rate * worn(tension * bond.opening, tension * opening) +
                           (shear_rate / shear_ratio) * worn(shear * abs(bond.slip), shear * abs(slip));
    constexpr double rounding = 1e-9;  // without a reversal both shares stick, or friction slips
    const Lanes whole = normal_stiffness * opening * opening + shear_stiffness * slip * slip;
    const LaneBits releases = shear_stiffness * elastic * elastic <= (1 + rounding) * whole;
    return select(releases, min(max(bond.damage + by_loads, by_opening), broadcast(1)), bond.damage);
  }

  /// Energy that the bond's growing damage dissipates in a step, J/m2. It is exactly the work of the mean of the old
  /// and the new traction, less the stored energy.
  Lanes damage_work(const Bond& bond, Lanes damage, Lanes opening, Lanes slip) const {
    return 0.5 * (damage - bond.damage) *
           (normal_stiffness * bond.opening * opening + shear_stiffness * bond.slip * slip);
  }

  /// Integral of (p - threshold) / (strength - threshold) dp along a growing stress, Pa.
  Lanes worn(Lanes from, Lanes to) const {
    const Lanes low = max(from - threshold, Lanes{}), high = max(to - threshold, low);
    return (0.5 / (strength - threshold)) * (high * high - low * low);
  }
};

}  // namespace pliant
