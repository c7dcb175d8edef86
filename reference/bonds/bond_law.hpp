#pragma once

#include "reference/bonds/bond.hpp"

namespace pliant::reference {

/// Law at the ends of a bond with all parameters as numbers (docs/method.md 11).
struct BondLaw {
  double kn = 0, kt = 0;                  ///< Pa/m
  double strength = 0, cohesion = 0;      ///< Pa
  double friction = 0;                    ///< tan(phi) of bond and contact together
  double energy_1 = 0, energy_2 = 0;      ///< G_I, G_II, J/m2
  bool bears_pressure = false;            ///< cement in a gap
  double contact_kn = 0, contact_kt = 0;  ///< of the contact beside it, Pa/m
  double contact_friction = 0;
  double threshold = 0;           ///< of fatigue, Pa
  double rate_1 = 0, rate_2 = 0;  ///< damage by growing tension and shear, 1/Pa

  /// Opening that has a traction: none of an overlap, unless the bond bears pressure.
  BondJet bearing(const BondJet& opening) const;
  /// Energy without damage per length, J/m2.
  BondJet energy(const BondJet& opening, const BondJet& slip) const;
  /// Damage that this opening and slip reach by themselves. `gap`: of the surfaces, m.
  BondJet damage(const BondJet& opening, const BondJet& slip, const BondJet& gap) const;
  /// Damage that the growth of tension and shear adds by fatigue to `old_damage`, from the displacements at the last
  /// accepted state on.
  BondJet fatigue(double old_damage, double old_opening, double old_slip, const BondJet& opening,
                  const BondJet& slip) const;

 private:
  BondJet shear_strength(const BondJet& slip, const BondJet& gap) const;
};

}  // namespace pliant::reference
