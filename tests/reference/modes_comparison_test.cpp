// Natural frequencies of the reference solver's tangent and masses against those of the engine's kernels (VERIFICATION 3a).
// INDEPENDENT: they share the mesh and the scene.
#include <gtest/gtest.h>

#include "dynamics/natural_modes.hpp"
#include "reference/natural_modes.hpp"
#include "reference/shapes.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr double tolerance = 1e-8;  ///< differences of forces err by 1e-11 of the stiffness, w^2 spans 1e3

Scene one_disc(const DiscretisationSettings& settings) {
  Scene scene = bare_scene();
  scene.discretisation = settings;
  scene.contacts = {frictionless(1)};
  scene.shapes = {disc(84, 1)};
  add_grain(scene, scene.shapes[0].name, BodyKind::compliant, {0, 0}, 0.4, "soft");
  scene.grains.back().size.factors = {0.7};
  return scene;
}

TEST(NaturalModesOfBoth, agree) {
  for (const Recipe recipe : {Recipe::mls, Recipe::mls_gauss, Recipe::t3, Recipe::es_t3})
    for (const Mass mass : {Mass::lumped, Mass::corrected}) {
      const Scene scene = one_disc({.recipe = recipe, .mass = mass});
      const Model model = build_model(scene);
      const NaturalModes engine = natural_modes(small_motions(model, model.bodies[0]));
      const reference::Bodies bodies(scene);
      const auto kind = mass == Mass::corrected ? reference::MassMatrix::corrected : reference::MassMatrix::lumped;
      const Eigen::VectorXd own = natural_frequencies(bodies, bodies.all()[0], kind);
      ASSERT_EQ(engine.motions_at_rest, 3);
      ASSERT_EQ(engine.frequency.size(), static_cast<std::size_t>(own.size()) - 3);
      for (std::size_t i = 0; i < engine.frequency.size(); ++i)
        ASSERT_NEAR(engine.frequency[i] / own[static_cast<Eigen::Index>(i) + 3], 1, tolerance) << i;
    }
}

}  // namespace
}  // namespace pliant
