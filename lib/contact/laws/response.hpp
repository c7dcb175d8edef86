#pragma once

#include <concepts>
#include <type_traits>

#include "contact/laws/traction.hpp"
#include "core/internal_variables.hpp"

namespace pliant {

/// Eight nodes near a master, in the step at hand.
struct GapAndSlip {
  Lanes gap;          ///< m, negative: penetration
  LaneBits beside;    ///< which of them face the master at all
  LaneBits touching;  ///< and are within the law's reach
  Lanes moved;        ///< past the master since the last accepted step, m; 0 for laws without shear
};

/// What a law makes of them: tractions, and slip brought up to date.
struct Contact {
  Lanes pressure, shear, energy;  ///< shear acts on the slave along the tangent
  Lanes slip, slip_work;          ///< slip_work: dissipated per length, by whatever, J/m2
};

/// Every law has has_shear, name, normal_stiffness shear_stiffness, Pa/m; reach, m: nodes with smaller
/// gaps touch; and Traction operator()(Lanes gap) const. One that remembers something besides place and slip
/// (core/internal_variables.hpp) brings
///
///     Contact respond(const GapAndSlip&, const Traction&, Lanes old_slip, const Record& old, Record& now) const;
///     Lanes set_free(Lanes old_slip, const Record& old) const;      J/m2, where none of eight is beside the master
///     Record at_start(Lanes gap, LaneBits beside) const;            with gaps up to
///     double start_reach() const;                                   m
///
/// respond is asked for lanes that are not beside, do not touch or are padding as well: what single nodes remember that
/// left, and what that sets free, is its own. Asked once more at the same place, from `now` and the new slip, it must
/// answer the same tractions: audits and probes do that. The limit of shear in the Traction is what operator() says of
/// the gap; respond may set another. Nothing else need know.

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

/// What a law lacks is said where it joins the others, contact/contact_law.hpp.
template <class Law>
concept CompleteContactLaw = AnswersGaps<Law> && (!has_internal_variables<Law> || AnswersGapAndSlip<Law>);

template <class Law>
constexpr bool has_dashpot = requires { Law::has_damping; };

/// The tangential part of a contact that slips beyond its limit.
template <class Law>
void slide(const Law& law, const Traction& traction, LaneBits touching, Lanes old_slip, Lanes trial, Contact& c) {
  const Lanes largest = select(touching, traction.shear_limit * (1 / law.shear_stiffness), Lanes{});
  c.slip = min(max(trial, -largest), largest);
  c.shear = -law.shear_stiffness * c.slip;
  // Mean of the old and the new traction times the plastic slip: what the tangential forces do, less what is stored.
  c.slip_work = (0.5 * law.shear_stiffness) * (old_slip + c.slip) * (trial - c.slip);
  c.energy += 0.5 * law.shear_stiffness * c.slip * c.slip;
}

/// Of laws without memory: more pressure than of the gap, as of a dashpot, and what friction makes of it, Pa.
template <class Law>
void add_pressure(const Law& law, Lanes more, Traction& traction) {
  const Lanes before = max(traction.pressure, Lanes{});
  traction.pressure += more;
  if constexpr (requires { law.friction; })
    traction.shear_limit += law.friction * (max(traction.pressure, Lanes{}) - before);
}

/// `traction`: the law's answer to the gap, and its dashpot's.
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

/// What nodes had stored that are no longer beside the master, J/m2.
template <class Law>
Lanes set_free(const Law& law, Lanes old_slip, const Record<Law>& old) {
  if constexpr (has_internal_variables<Law>)
    return law.set_free(old_slip, old);
  else
    return (0.5 * law.shear_stiffness) * old_slip * old_slip;
}

}  // namespace pliant
