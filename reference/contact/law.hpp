#pragma once

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
  double cohesion = 0;        ///< mohr-coulomb: shear limit without pressure, Pa
  double strength = 0;        ///< cohesive, Pa
  double shear_strength = 0;  ///< cohesive, Pa
  bool shears() const {
    switch (kind) {
      case ContactLawKind::frictionless:
        return false;
      case ContactLawKind::mohr_coulomb:
      case ContactLawKind::cohesive:
        return true;
    }
    return true;
  }
};

/// Tractions at one node and the updated slip.
struct Response {
  using Gradient = Jet<2>::Gradient;
  double pressure = 0;  ///< positive in compression, Pa
  double shear = 0;     ///< resists the motion: - shear acts on the slave along the segment, Pa
  Gradient pressure_by = Gradient::Zero(), shear_by = Gradient::Zero();  ///< derivatives by gap and motion, Pa/m
  double stored = 0;                                                     ///< J/m2
  double dissipated = 0;                                                 ///< since the last accepted state, J/m2
  double slip = 0;                                                       ///< elastic, m
};

/// Response at a node in contact (gap < reach) with the elastic slip `old_slip` at the last accepted state and the slip
/// increment `motion` along the outline since then, m.
Response respond(const Law& law, double old_slip, double gap, double motion);

/// Largest shear traction at a gap within reach, with derivatives, Pa.
Jet<2> shear_limit(const Law& law, const Jet<2>& gap);

/// Energy in shear that a node loses at the end of contact, J/m2.
double parting_loss(const Law& law, double slip);

}  // namespace pliant::reference
