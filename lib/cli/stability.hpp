#pragma once

#include <optional>
#include <string>

#include "bodies/model.hpp"

namespace pliant {

/// How many times as stiff contacts are taken for comparison.
inline constexpr double stiffer = 10;

/// The bound at the start, whatever the integrator: step doubling does not use it, but cannot go far beyond.
struct Stability {
  double dt = 0, stiffer_dt = 0;  ///< s; infinite when nothing is stiff
  std::string governing;
};
Stability stability(const Model& model);

/// By how much [discretisation] mass_scaling slows a uniform stretch of compliant grains, over its frequency: the
/// largest of all shapes. Lowest vibrations are slowed by as much or some more. 0 without mass scaling.
double slowed_by_mass_scaling(const Model& model);

/// What mass scaling could do for a scene without it: try it. Nothing where steps do not depend on it, or for scenes of
/// more bodies than are tried within a second or so.
std::optional<std::string> advice_on_mass_scaling(const Model& model, const Stability& as_it_is);

}  // namespace pliant
