#pragma once

#include <concepts>
#include <type_traits>

#include "contact/laws/traction.hpp"

namespace pliant {

/// Response of a law: tractions, energy and updated slip.
struct Contact {
  Lanes pressure, shear, energy;  ///< shear acts on the slave along the tangent
  Lanes slip, slip_work;          ///< slip_work: energy dissipated per length by friction, J/m2
};

/// Each law has has_shear and name; normal_stiffness and shear_stiffness, Pa/m; reach, m: nodes with smaller gaps are
/// in contact; and Traction operator()(Lanes gap) const. No other code depends on the law. What remembers more than its
/// slip, such as damage, is a bond (bonds/bond_law.hpp). A missing member is reported where the law joins the others,
/// in contact/contact_law.hpp.
template <class Law>
concept CompleteContactLaw = requires(const Law& law, Lanes gap) {
  requires std::same_as<std::remove_cv_t<decltype(Law::has_shear)>, bool>;
  requires std::convertible_to<decltype(Law::name), const char*>;
  requires std::same_as<std::remove_cvref_t<decltype(law.normal_stiffness)>, double>;
  requires std::same_as<std::remove_cvref_t<decltype(law.shear_stiffness)>, double>;
  requires std::same_as<std::remove_cvref_t<decltype(law.reach)>, double>;
  { law(gap) } -> std::same_as<Traction>;
};

template <class Law>
constexpr bool has_dashpot = requires { Law::has_damping; };

/// Return mapping of the slip of a contact to its limit of shear.
template <class Law>
void slide(const Law& law, const Traction& traction, LaneBits touching, Lanes old_slip, Lanes trial, Contact& c) {
  const Lanes largest = select(touching, traction.shear_limit * (1 / law.shear_stiffness), Lanes{});
  c.slip = min(max(trial, -largest), largest);
  c.shear = -law.shear_stiffness * c.slip;
  // Mean of the old and the new traction times the plastic slip: work of the tangential forces, less the stored energy.
  c.slip_work = (0.5 * law.shear_stiffness) * (old_slip + c.slip) * (trial - c.slip);
  c.energy += 0.5 * law.shear_stiffness * c.slip * c.slip;
}

/// Adds a pressure that does not follow from the gap, such as a dashpot's, and the friction that it allows, Pa.
template <class Law>
void add_pressure(const Law& law, Lanes more, Traction& traction) {
  const Lanes before = max(traction.pressure, Lanes{});
  traction.pressure += more;
  if constexpr (requires { law.friction; })
    traction.shear_limit += law.friction * (max(traction.pressure, Lanes{}) - before);
}

/// `traction`: the law's response to the gap, with its dashpot's. `touching`: lanes within the law's reach. `moved`:
/// slip increment since the last accepted step, m.
template <class Law>
Contact respond(const Law& law, const Traction& traction, LaneBits touching, Lanes old_slip, Lanes moved) {
  Contact c{traction.pressure, {}, traction.energy, {}, {}};
  if constexpr (Law::has_shear) slide(law, traction, touching, old_slip, old_slip + moved, c);
  return c;
}

/// Energy that nodes had stored that no longer project onto the master, J/m2.
template <class Law>
Lanes set_free(const Law& law, Lanes old_slip) {
  return (0.5 * law.shear_stiffness) * old_slip * old_slip;
}

}  // namespace pliant
