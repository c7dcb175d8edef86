#pragma once

#include <optional>

#include "reference/contact/contacts.hpp"
#include "reference/jet.hpp"

namespace pliant::reference {

/// A contact rule as it holds between two bodies: everything in numbers.
struct Law {
  ContactLawKind kind = ContactLawKind::frictionless;
  double kn = 0, kt = 0;  ///< Pa/m
  double start = 0;       ///< penetration up to which the pressure grows quadratically, m
  double reach = 0;       ///< gap from which on nothing acts, m
  double friction = 0;
  double cohesion = 0;              ///< mohr-coulomb: shear limit without pressure, Pa
  double strength = 0;              ///< cohesive laws, Pa
  double shear_strength = 0;        ///< cohesive, Pa
  double residual_strength = 0;     ///< cohesive-fatigue, of what is broken, Pa
  double ratio = 1;                 ///< cohesive-fatigue: normal over shear strength
  double bond_gap = 0;              ///< m
  double threshold = 0;             ///< Pa
  double rate = 0, shear_rate = 0;  ///< 1/Pa
  bool shears() const {
    switch (kind) {
      case ContactLawKind::frictionless:
        return false;
      case ContactLawKind::mohr_coulomb:
      case ContactLawKind::cohesive:
      case ContactLawKind::cohesive_fatigue:
        return true;
    }
    return true;
  }
  bool bonds() const {
    switch (kind) {
      case ContactLawKind::frictionless:
      case ContactLawKind::mohr_coulomb:
      case ContactLawKind::cohesive:
        return false;
      case ContactLawKind::cohesive_fatigue:
        return true;
    }
    return false;
  }
};

/// Tractions at one node and what they leave behind.
struct Response {
  using Gradient = Jet<2>::Gradient;
  double pressure = 0;  ///< pushes; Pa
  double shear = 0;     ///< resists the motion: the slave feels - shear along the segment, Pa
  Gradient pressure_by = Gradient::Zero(), shear_by = Gradient::Zero();  ///< derivatives by gap and motion, Pa/m
  double stored = 0;                                                     ///< J/m2
  double dissipated = 0;                                                 ///< since the last accepted state, J/m2
  double slip = 0, friction_slip = 0, damage = 1, opening = 0;           ///< to remember
};

/// Of a node in touch (gap < reach) that has moved by `motion` along the outline since the memory was accepted.
/// `initial`: of the first state, in which bonds are as they are and nothing has moved.
Response respond(const Law& law, const ContactMemory& memory, double gap, double motion, bool initial);

/// Largest shear traction at a gap within reach, with derivatives, Pa.
Jet<2> shear_limit(const Law& law, const Jet<2>& gap);

/// Of a node that gets out of touch: what it loses of the energy in shear and in its bond, J/m2. `gap`: of a node that
/// is still beside the other body; its bond is stretched that far when it tears.
double parting_loss(const Law& law, const ContactMemory& memory, std::optional<double> gap);

}  // namespace pliant::reference
