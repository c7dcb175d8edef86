// What `check` foretells of discretisations: interpolation of what was measured.
#include "cli/expected_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cli/measured_errors.hpp"
#include "setup/build_model.hpp"
#include "support/scenes.hpp"

namespace pliant::testing {
namespace {

// EXACT: what was measured where it was, a power of the number of nodes between, the nearest beyond.
TEST(ExpectedErrors, go_by_powers_between_sizes) {
  for (const MeasuredErrors& known : measured_errors) {
    const auto at = [&](int nodes) { return expected_errors(known.method, known.mass, nodes)->oscillation; };
    for (std::size_t i = 0; i < std::size(measured_nodes); ++i)
      EXPECT_NEAR(at(measured_nodes[i]), known.oscillation[i], 1e-12 * known.oscillation[i]);
    const double power =
        std::log(known.oscillation[1] / known.oscillation[0]) / std::log(1.0 * measured_nodes[1] / measured_nodes[0]);
    EXPECT_NEAR(at(60), known.oscillation[0] * std::pow(60.0 / measured_nodes[0], power), 1e-12);
    EXPECT_EQ(at(12), known.oscillation[0]);
    EXPECT_EQ(at(100'000), known.oscillation[std::size(measured_nodes) - 1]);
  }
}

TEST(ExpectedErrors, are_known_of_all_methods_but_the_one_for_comparison) {
  for (const DiscretisationMethod method : {DiscretisationMethod::mls, DiscretisationMethod::mls_gauss,
                                            DiscretisationMethod::t3, DiscretisationMethod::es_t3})
    for (const Mass mass : {Mass::lumped, Mass::corrected}) EXPECT_TRUE(expected_errors(method, mass, 168));
  EXPECT_FALSE(expected_errors(DiscretisationMethod::rpim, Mass::lumped, 168));
}

TEST(ExpectedErrors, of_a_scene_are_those_of_its_coarsest_grains) {
  Scene scene = empty_scene(1);
  scene.shapes = {disc_shape("fine", 2, 100), disc_shape("coarse", 2, 40)};
  for (const char* shape : {"fine", "coarse"})
    add_grain(scene, shape, BodyKind::compliant, {static_cast<double>(3 * scene.grains.size()), 0});
  const std::string text = describe_expected_errors(build_model(scene));
  EXPECT_NE(text.find("discs of 40 nodes"), std::string::npos) << text;
  EXPECT_NE(text.find("mass = \"corrected\""), std::string::npos) << text;
  scene.discretisation.mass = Mass::corrected;
  EXPECT_EQ(describe_expected_errors(build_model(scene)).find("mass ="), std::string::npos);
  for (Grains& grains : scene.grains) grains.species[0] = {BodyKind::rigid, "hard", 1};
  EXPECT_EQ(describe_expected_errors(build_model(scene)), "") << "nothing compliant";
}

}  // namespace
}  // namespace pliant::testing
