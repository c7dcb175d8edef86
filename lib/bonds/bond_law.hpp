#pragma once

#include "bonds/bond.hpp"
#include "core/lanes.hpp"

namespace pliant {

/// Law of an end of a bond: an intrinsic cohesive zone with damage D and linear softening (docs/method.md 11). Its
/// energy per length is (1 - D) (kn u^2 + kt s^2) / 2 with the opening u and the slip s since the bond was made. Damage
/// begins at the quadratic criterion of strengths, (kn u/strength)^2 + (kt s/shear strength)^2 = 1. In mixed mode the
/// fracture energy follows the linear power law, G_1/G_I + G_2/G_II = 1. N is Lanes or double.
template <class N>
struct BondLaw {
  N normal_stiffness, shear_stiffness;                   ///< kn, kt, Pa/m
  N strength, cohesion;                                  ///< Pa
  N friction;                                            ///< tan(phi) of whole bonds
  N energy_1, energy_2;                                  ///< G_I, G_II, J/m2
  N threshold;                                           ///< of fatigue, over the strength
  N rate_1, rate_2;                                      ///< damage by growing stresses, over the strengths
  N bears_pressure;                                      ///< 1: cement in a gap; 0: pressure is left to contact
  N contact_stiffness, contact_shear, contact_friction;  ///< of the contact law beside it

  struct Response {
    N pull, shear;  ///< on the master towards the slave and against the slip, Pa
    N energy;       ///< stored, J/m2
    N loss;         ///< by damage since the last accepted step, J/m2
  };

  /// `gap`: between the two surfaces, m, which gives the pressure that contact bears there. `now.damage` is set.
  template <class End>
  Response respond(N gap, const End& old, End& now) const {
    const N opening = select(bears_pressure > 0.0, now.opening, max(now.opening, N{})), tension = max(now.opening, N{});
    const N slip = now.slip;
    now.opening = opening;
    now.damage = max(old.damage, damage(tension, slip, max(-gap, N{})));
    if (any((rate_1 + rate_2) > 0.0)) now.damage = max(now.damage, worn(old, tension, slip));
    const N whole = 1.0 - now.damage, kn = normal_stiffness, kt = shear_stiffness;
    return {whole * kn * opening, whole * kt * slip, 0.5 * whole * (kn * opening * opening + kt * slip * slip),
            // the work of the mean of both tractions less the stored energy
            0.5 * (now.damage - old.damage) * (kn * old.opening * opening + kt * old.slip * slip)};
  }

  /// Damage under a growing load of this mode. With r^2 the left side of the criterion of strengths and q that of the
  /// criterion of energies it is r (r - 1)/(r^2 - q): the traction falls linearly to zero, where q = r.
  N damage(N tension, N slip, N depth) const {
    const N normal = normal_stiffness * tension, shear = shear_stiffness * abs(slip);
    const N by_normal = normal / strength, by_shear = shear / shear_strength(depth, abs(slip));
    const N r2 = by_normal * by_normal + by_shear * by_shear, r = sqrt(r2);
    const N q = 0.5 * (normal * tension / energy_1 + shear * abs(slip) / energy_2);
    const N softening = r * (r - 1.0) / max(r2 - q, N{} + 1e-300);
    return select(r <= 1.0, N{}, select(q >= r, N{} + 1.0, min(softening, N{} + 1.0)));
  }

  /// Damage by a step of fatigue: each growing stress p adds rate (p - threshold)/(strength - threshold) dp, in shear
  /// with the ratio of the strengths.
  template <class End>
  N worn(const End& old, N tension, N slip) const {
    const N whole = 1.0 - old.damage, normal = whole * normal_stiffness / strength,
            shear = whole * shear_stiffness / cohesion;
    const N grown = rate_1 * growth(normal * max(old.opening, N{}), normal * tension) +
                    rate_2 * growth(shear * abs(old.slip), shear * abs(slip));
    return min(old.damage + grown, N{} + 1.0);
  }
  /// Integral of (p - threshold)/(1 - threshold) dp along a growing stress over its strength.
  N growth(N from, N to) const {
    const N low = max(from - threshold, N{}), high = max(to - threshold, low);
    return 0.5 / (1.0 - threshold) * (high * high - low * low);
  }

  /// Shear strength of the bond alone: that of bond and contact together, cohesion + tan(phi) p, less what the contact
  /// beside it bears by friction. It is at least the cohesion, as tan(phi) is not less than the friction of contact.
  N shear_strength(N depth, N slip) const {
    const N pressure = contact_stiffness * depth;
    const N by_contact = min(contact_friction * pressure, select(depth > 0.0, contact_shear * slip, N{}));
    return cohesion + friction * pressure - by_contact;
  }
};

}  // namespace pliant
