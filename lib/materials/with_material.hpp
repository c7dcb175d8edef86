#pragma once

#include <stdexcept>

#include "materials/linear_elastic.hpp"
#include "materials/melody.hpp"
#include "materials/neo_hookean.hpp"
#include "materials/neo_hookean_quadratic.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Calls action(Law{}) with the law that was asked for: chosen once, outside every loop.
template <class Action>
auto with_material(MaterialLaw law, Action&& action) {
  switch (law) {
    case MaterialLaw::neo_hookean:
      return action(NeoHookean{});
    case MaterialLaw::neo_hookean_quadratic:
      return action(NeoHookeanQuadratic{});
    case MaterialLaw::melody:
      return action(Melody{});
    case MaterialLaw::linear_elastic:
      return action(LinearElastic{});
    case MaterialLaw::rigid:
      break;
  }
  throw std::logic_error("a material law that deforms nothing");
}

}  // namespace pliant
