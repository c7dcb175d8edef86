#pragma once

#include <optional>
#include <string>

#include "bodies/model.hpp"

namespace pliant {

/// What a disc is off by where solutions are known, all else by default; relative. `./pliant bench error` has the
/// scenes.
struct ExpectedErrors {
  double oscillation;  ///< stretch of one that swings by a fifth, three times, over its swing
  double plates;       ///< forces on plates that squeeze it by up to 30 %
  double impact;       ///< velocity while it bounces at a fifth of the speed of shear waves, over its speed
};

/// Of discs of so many nodes: between those that were measured, by powers of their number; beyond, of the nearest.
/// Nothing of methods that were not.
std::optional<ExpectedErrors> expected_errors(DiscretisationMethod method, Mass mass, int nodes);

/// Of the scene's coarsest compliant grains, with what the other mass would change. Empty where there is nothing to
/// say.
std::string describe_expected_errors(const Model& model);

}  // namespace pliant
