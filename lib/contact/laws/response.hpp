#pragma once

#include <concepts>
#include <type_traits>

#include "contact/laws/traction.hpp"
#include "core/internal_variables.hpp"

namespace pliant {

/// Gap and slip increment of eight nodes near a master, in the current step.
struct GapAndSlip {
  Lanes gap;          ///< m, negative: penetration
  LaneBits projects;  ///< lanes that project onto the master
  LaneBits touching;  ///< of these, lanes within the law's reach
  Lanes moved;        ///< slip increment since the last accepted step, m; 0 for laws without shear
};

/// Response of a law: tractions, energy and updated slip.
struct Contact {
  Lanes pressure, shear, energy;  ///< shear acts on the slave along the tangent
  Lanes slip, slip_work;          ///< slip_work: energy dissipated per length by friction or damage, J/m2
};

/// Each law has has_shear and name; normal_stiffness and shear_stiffness, Pa/m; reach, m: nodes with smaller gaps are
/// in contact; and Traction operator()(Lanes gap) const. A law with internal variables (core/internal_variables.hpp)
/// also has
///
///     Contact respond(const GapAndSlip&, const Traction&, Lanes old_slip, const Record& old, Record& now) const;
///     Lanes set_free(Lanes old_slip, const Record& old) const;      J/m2, where none of eight projects on the master
///     Record at_start(Lanes gap, LaneBits projects) const;            with gaps up to
///     double start_reach() const;                                   m
///
/// respond is also called for lanes without a projection, out of contact, or padding. It sets the internal variables of
/// single nodes that have left contact, and accounts for the energy that these release. Called once more at the same
/// place, with `now` and the new slip, it must return the same tractions, because the energy balance and probes do so.
/// The shear limit in the Traction is that of operator(); respond may use another. No other code depends on the law.

template <class Law>
concept AnswersGaps = requires(const Law& law, Lanes gap) {
  requires std::same_as<std::remove_cv_t<decltype(Law::has_shear)>, bool>;
  requires std::convertible_to<decltype(Law::name), const char*>;
  requires std::same_as<std::remove_cvref_t<decltype(law.normal_stiffness)>, double>;
  requires std::same_as<std::remove_cvref_t<decltype(law.shear_stiffness)>, double>;
  requires std::same_as<std::remove_cvref_t<decltype(law.reach)>, double>;
  { law(gap) } -> std::same_as<Traction>;
};
template <class Law>
concept AnswersGapAndSlip = requires(const Law& law, const GapAndSlip& at, const Traction& traction, Lanes number,
                                     LaneBits which, const Record<Law>& old, Record<Law>& now) {
  { law.respond(at, traction, number, old, now) } -> std::same_as<Contact>;
  { law.set_free(number, old) } -> std::same_as<Lanes>;
  { law.at_start(number, which) } -> std::same_as<Record<Law>>;
  { law.start_reach() } -> std::convertible_to<double>;
};

/// A missing member is reported where the law joins the others, in contact/contact_law.hpp.
template <class Law>
concept CompleteContactLaw = AnswersGaps<Law> && (!has_internal_variables<Law> || AnswersGapAndSlip<Law>);

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

/// Adds a pressure that does not follow from the gap, such as a dashpot's, and the friction that it allows, Pa. For
/// laws without internal variables.
template <class Law>
void add_pressure(const Law& law, Lanes more, Traction& traction) {
  const Lanes before = max(traction.pressure, Lanes{});
  traction.pressure += more;
  if constexpr (requires { law.friction; })
    traction.shear_limit += law.friction * (max(traction.pressure, Lanes{}) - before);
}

/// `traction`: the law's response to the gap, with its dashpot's.
template <class Law>
Contact respond(const Law& law, const GapAndSlip& at, const Traction& traction, Lanes old_slip, const Record<Law>& old,
                Record<Law>& now) {
  if constexpr (has_internal_variables<Law>) {
    return law.respond(at, traction, old_slip, old, now);
  } else {
    Contact c{traction.pressure, {}, traction.energy, {}, {}};
    if constexpr (Law::has_shear) slide(law, traction, at.touching, old_slip, old_slip + at.moved, c);
    return c;
  }
}

/// Energy that nodes had stored that no longer project onto the master, J/m2.
template <class Law>
Lanes set_free(const Law& law, Lanes old_slip, const Record<Law>& old) {
  if constexpr (has_internal_variables<Law>)
    return law.set_free(old_slip, old);
  else
    return (0.5 * law.shear_stiffness) * old_slip * old_slip;
}

}  // namespace pliant
