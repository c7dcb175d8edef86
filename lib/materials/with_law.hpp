#pragma once

#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "materials/drucker_prager.hpp"
#include "materials/linear_elastic.hpp"
#include "materials/melody.hpp"
#include "materials/neo_hookean.hpp"
#include "materials/neo_hookean_maxwell.hpp"
#include "materials/neo_hookean_quadratic.hpp"
#include "materials/von_mises.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Calls action(type_identity<Law<T>>) with the law of this name: selected once, outside all loops.
template <class T, class Action>
auto with_law_type(MaterialLaw law, Action&& any_action) {
  const auto action = [&]<CompleteMaterialLaw Law>(std::type_identity<Law> type) { return any_action(type); };
  switch (law) {
    case MaterialLaw::neo_hookean:
      return action(std::type_identity<NeoHookean<T>>());
    case MaterialLaw::neo_hookean_quadratic:
      return action(std::type_identity<NeoHookeanQuadratic<T>>());
    case MaterialLaw::melody:
      return action(std::type_identity<Melody<T>>());
    case MaterialLaw::linear_elastic:
      return action(std::type_identity<LinearElastic<T>>());
    case MaterialLaw::neo_hookean_maxwell:
      return action(std::type_identity<NeoHookeanMaxwell<T>>());
    case MaterialLaw::von_mises:
      return action(std::type_identity<VonMises<T>>());
    case MaterialLaw::drucker_prager:
      return action(std::type_identity<DruckerPrager<T>>());
    case MaterialLaw::rigid:
      break;
  }
  throw std::logic_error("a material that does not deform has no law");
}

/// Calls action(law) with the law of one material.
template <class Action>
auto with_law(const Material& material, Action&& action) {
  return with_law_type<double>(material.law,
                               [&]<class Law>(std::type_identity<Law>) { return action(Law::of(material)); });
}

/// Constants of eight materials with one form of law, one per lane, in the order of the law's members.
using LawConstants = std::vector<Lanes>;

inline void set_law_constants(const Material& material, int lane, LawConstants& constants) {
  with_law(material, [&]<class Law>(const Law& law) {
    static_assert(std::is_trivially_copyable_v<Law> && sizeof(Law) % sizeof(double) == 0);
    double values[sizeof(Law) / sizeof(double)];
    std::memcpy(values, &law, sizeof law);
    constants.resize(std::size(values));
    for (std::size_t i = 0; i < constants.size(); ++i) constants[i][lane] = values[i];
  });
}

/// Calls action(law) with the law of eight materials.
template <class Action>
auto with_law(MaterialLaw law, const LawConstants& constants, Action&& action) {
  return with_law_type<Lanes>(law, [&]<class Law>(std::type_identity<Law>) {
    Law of_lanes;
    std::memcpy(static_cast<void*>(&of_lanes), constants.data(), sizeof of_lanes);
    return action(of_lanes);
  });
}

}  // namespace pliant
