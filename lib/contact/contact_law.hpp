#pragma once

#include <algorithm>
#include <variant>

#include "contact/laws/cohesive.hpp"
#include "contact/laws/damped.hpp"
#include "contact/laws/frictionless.hpp"
#include "contact/laws/mohr_coulomb.hpp"
#include "contact/laws/response.hpp"
#include "contact/laws/smoothed.hpp"

namespace pliant {

/// Variant of complete contact laws.
template <CompleteContactLaw... Laws>
using AnyOf = std::variant<Laws...>;

/// Contact law of one pair of bodies.
using ContactLaw = AnyOf<Frictionless, MohrCoulomb, Cohesive, Smoothed<Frictionless>, Smoothed<MohrCoulomb>,
                         Damped<Frictionless>, Damped<MohrCoulomb>>;

inline double reach_of(const ContactLaw& law) {
  return std::visit([](const auto& l) { return l.reach; }, law);
}
inline double normal_stiffness_of(const ContactLaw& law) {
  return std::visit([](const auto& l) { return l.normal_stiffness; }, law);
}
inline double stiffness_of(const ContactLaw& law) {
  return std::visit(
      [](const auto& l) { return l.has_shear ? std::max(l.normal_stiffness, l.shear_stiffness) : l.normal_stiffness; },
      law);
}
/// Whether the law has a dashpot.
inline bool is_damped(const ContactLaw& law) {
  return std::visit([]<class Law>(const Law&) { return has_dashpot<Law>; }, law);
}

}  // namespace pliant
