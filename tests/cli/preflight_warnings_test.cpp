// Warnings before a run.
#include "cli/preflight_warnings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

bool warns_of_locking(MaterialLaw law, DiscretisationMethod method) {
  Scene scene = free_disc(60, 1);
  scene.materials[0] = elastic();
  scene.materials[0].law = law, scene.materials[0].yield = 0.03;
  scene.materials[0].friction_angle = 0.5, scene.materials[0].cohesion = 0.01;
  scene.discretisation.method = method;
  const std::vector<std::string> all = preflight_warnings(build_model(scene));
  return std::ranges::any_of(all, [](const std::string& text) { return text.find("locks") != std::string::npos; });
}

// EXACT: linear triangles with a law that flows at constant volume, and nothing else.
TEST(PreflightWarnings, tell_of_locking) {
  EXPECT_TRUE(warns_of_locking(MaterialLaw::von_mises, DiscretisationMethod::t3));
  EXPECT_FALSE(warns_of_locking(MaterialLaw::von_mises, DiscretisationMethod::mls));
  EXPECT_FALSE(warns_of_locking(MaterialLaw::von_mises, DiscretisationMethod::es_t3));
  EXPECT_FALSE(warns_of_locking(MaterialLaw::drucker_prager, DiscretisationMethod::t3));
  EXPECT_FALSE(warns_of_locking(MaterialLaw::neo_hookean, DiscretisationMethod::t3));
}

}  // namespace
}  // namespace pliant::dynamics_tests
