#pragma once

#include <optional>

#include "reference/contact/contacts.hpp"
#include "reference/jet.hpp"

namespace pliant::reference {

/// Contact law between two bodies with all parameters as numbers.
struct Law {
  ContactLawKind kind = ContactLawKind::frictionless;
  double kn = 0, kt = 0;  ///< Pa/m
  double start = 0;       ///< penetration up to which the pressure is quadratic, m
  double reach = 0;       ///< gap from which on the law is zero, m
  double friction = 0;
  double cohesion = 0;              ///< mohr-coulomb: shear limit without pressure, Pa
  double strength = 0;              ///< cohesive laws, Pa
  double shear_strength = 0;        ///< cohesive, Pa
  double residual_strength = 0;     ///< cohesive-fatigue, of broken surfaces, Pa
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

/// Tractions at one node and the updated history variables.
struct Response {
  using Gradient = Jet<2>::Gradient;
  double pressure = 0;  ///< positive in compression, Pa
  double shear = 0;     ///< resists the motion: - shear acts on the slave along the segment, Pa
  Gradient pressure_by = Gradient::Zero(), shear_by = Gradient::Zero();  ///< derivatives by gap and motion, Pa/m
  double stored = 0;                                                     ///< J/m2
  double dissipated = 0;                                                 ///< since the last accepted state, J/m2
  double slip = 0, friction_slip = 0, damage = 1, opening = 0;           ///< history variables
};

/// Response at a node in contact (gap < reach) with the slip increment `motion` along the outline since the history was
/// accepted. `initial`: at the first state, with initial bonds and without motion.
Response respond(const Law& law, const ContactMemory& memory, double gap, double motion, bool initial);

/// Largest shear traction at a gap within reach, with derivatives, Pa.
Jet<2> shear_limit(const Law& law, const Jet<2>& gap);

/// Energy in shear and in its bond that a node loses at the end of contact, J/m2. `gap`: of a node that still has a
/// projection; its bond is stretched by this gap when it breaks.
double parting_loss(const Law& law, const ContactMemory& memory, std::optional<double> gap);

}  // namespace pliant::reference
