#pragma once

#include "contact/laws/cohesive.hpp"
#include "contact/laws/response.hpp"

namespace pliant {

/// Bonds with damage D (docs/method.md 4). One potential, psi = kn min(g, 0)^2 / 2 + (1 - D) (kn max(g, 0)^2 + kt s^2)
/// / 2, gives pressure and shear: so the shear stiffness is kn / r^2 for strengths in the ratio r. With the opening
/// delta = sqrt(max(g, 0)^2 + (s/r)^2) the energy release rate is -dpsi/dD = kn delta^2 / 2. Along a growing opening D
/// = g_max (delta - g_c) / (delta (g_max - g_c)) makes the traction fall in a straight line from the strength at g_c =
/// strength / kn to zero at g_max, which takes strength g_max / 2. Above a threshold stress each growing stress p adds
/// dD = rate (p - threshold) / (strength - threshold) dp, in shear with stresses times r. The bond has no limit of slip
/// but its damage. Where D = 1, at any time, the cohesive law is left with the residual strength, and friction.
struct CohesiveFatigue {
  static constexpr bool has_shear = true;
  static constexpr const char* name = "cohesive-fatigue";
  static constexpr Remembered remembered[] = {{"damage", 1}, {"opening", 0}};  ///< 1: no bond is left; max(g, 0), m
  double normal_stiffness = 0;                                                 ///< kn, Pa/m
  double shear_stiffness = 0;                                                  ///< kn / r^2, Pa/m
  double reach = 0;                                                            ///< g_max, m; larger than strength / kn
  double strength = 0;                                                         ///< Pa
  double shear_ratio = 1;                                                      ///< r
  double residual_strength = 0;                                                ///< Pa
  double friction = 0;                                                         ///< of broken contacts
  double threshold = 0;                                                        ///< Pa
  double rate = 0, shear_rate = 0;                                             ///< 1/Pa
  double bond_gap = 0;  ///< gaps up to this are bonds at the start, m

  using Record = pliant::Record<CohesiveFatigue>;

  /// Tractions of what is broken.
  Traction operator()(Lanes gap) const {
    const Cohesive residual{normal_stiffness, shear_stiffness, reach, residual_strength,
                            residual_strength / shear_ratio};
    Traction traction = residual(gap);
    traction.shear_limit += friction * max(traction.pressure, Lanes{});
    return traction;
  }

  /// Bonds where there are some, and what is left of them elsewhere. `broken`: tractions of that.
  Contact respond(const Encounter& at, const Traction& broken, Lanes old_slip, const Record& old, Record& now) const {
    const Bond bond{old[0], old[1], old_slip};
    const LaneBits bonded = bond.damage < 1.0;
    now = {broadcast(1), select(at.beside, max(at.gap, Lanes{}), Lanes{})};
    Contact c{broken.pressure, {}, broken.energy, {}, {}};
    slide(*this, broken, at.touching, old_slip, old_slip + at.moved, c);
    if (!any(bonded)) return c;
    Lanes damage;
    const Contact b = stretch(at, broken, bond, old_slip + at.moved, damage);
    now[0] = select(bonded, damage, broadcast(1));
    return {select(bonded, b.pressure, c.pressure), select(bonded, b.shear, c.shear),
            select(bonded, b.energy, c.energy), select(bonded, b.slip, c.slip),
            select(bonded, b.slip_work, c.slip_work)};
  }

  Lanes set_free(Lanes old_slip, const Record& old) const {
    const Bond bond{old[0], old[1], old_slip};
    const Lanes sheared = (0.5 * shear_stiffness) * old_slip * old_slip;
    return select(bond.damage < 1.0, damage_work(bond, broadcast(1), bond.opening, bond.slip), sheared);
  }

  double start_reach() const { return bond_gap; }
  Record at_start(Lanes gap, LaneBits beside) const {
    const LaneBits near = beside & (gap <= bond_gap);
    return {select(near, Lanes{}, broadcast(1)), select(near, max(gap, Lanes{}), Lanes{})};
  }

 private:
  /// A bond at the last accepted step.
  struct Bond {
    Lanes damage, opening, slip;
  };

  /// Of bonds. Nodes that are no longer beside the master tear off.
  Contact stretch(const Encounter& at, const Traction& broken, const Bond& bond, Lanes slip, Lanes& now_damaged) const {
    const Lanes opening = select(at.beside, max(at.gap, Lanes{}), bond.opening);
    now_damaged = select(at.beside, damage(bond, opening, slip), broadcast(1));
    const LaneBits torn = now_damaged >= 1.0;
    const Lanes intact = 1.0 - now_damaged, depth = min(at.gap, Lanes{});
    const Lanes pressed = 0.5 * normal_stiffness * depth * depth;
    Contact c;
    c.pressure = select(torn, broken.pressure, -normal_stiffness * (depth + intact * opening));
    c.slip = select(torn, Lanes{}, slip);
    c.shear = -shear_stiffness * intact * c.slip;
    c.energy =
        select(torn, broken.energy,
               pressed + 0.5 * intact * (normal_stiffness * opening * opening + shear_stiffness * c.slip * c.slip));
    // A torn bond leaves the residual attraction, whose energy counts from separated surfaces.
    const Lanes left_over = select(torn & at.beside, pressed - broken.energy, Lanes{});
    c.slip_work = damage_work(bond, now_damaged, opening, slip) + left_over;
    return c;
  }

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

  /// Work that the bond's growing damage takes in a step, J/m2: the mean of the old and the new traction along the way,
  /// less what is stored, is exactly this.
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
