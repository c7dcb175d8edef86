// Added mass on outlines: inertia without weight, for longer steps.
#include <gtest/gtest.h>

#include <numeric>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

Scene with_rim(Scene scene, double mass_scaling) {
  scene.discretisation.mass_scaling = mass_scaling;
  return scene;
}

/// EXACT: nodes on the outline are so many times as heavy, no others; the share is that of the mass before.
TEST(RimMass, makes_outline_nodes_heavier) {
  for (const DiscretisationMethod method : {DiscretisationMethod::mls, DiscretisationMethod::es_t3}) {
    Scene scene = free_disc(90, 1);
    scene.discretisation.method = method;
    const Model plain = build_model(scene), heavy = build_model(with_rim(scene, 1.7));
    const std::vector<double>&before = plain.shapes[0].space.mass_at_unit_density,
          &now = heavy.shapes[0].space.mass_at_unit_density;
    const std::size_t outline = static_cast<std::size_t>(plain.shapes[0].space.mesh.outline_count);
    ASSERT_GT(outline, 10u);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_DOUBLE_EQ(now[i], (i < outline ? 1.7 : 1) * before[i]);
    const double ratio =
        std::accumulate(before.begin(), before.end(), 0.0) / std::accumulate(now.begin(), now.end(), 0.0);
    EXPECT_DOUBLE_EQ(heavy.shapes[0].space.weight_share, ratio);
    EXPECT_EQ(plain.shapes[0].space.weight_share, 1);
  }
}

/// EXACT: weight is what it was, so that a grain with more inertia falls more slowly; the energy balance closes.
TEST(RimMass, adds_no_weight) {
  for (const int count : {1, 9}) {
    Scene scene = empty_scene(1);
    scene.gravity = {0.3, -1};
    scene.shapes = {disc_shape("disc", 2, 90)};
    for (int i = 0; i < count; ++i)
      scene.grains.push_back(grains("disc" + std::to_string(i), "disc", BodyKind::compliant, {{3.0 * i, 0}}));
    const Model model = build_model(with_rim(scene, 2));
    const double share = model.shapes[0].space.weight_share;
    EXPECT_LT(share, 0.95);
    Simulation simulation(model);
    advance(simulation, 1);
    for (const Body& body : model.bodies) {
      const Vec2 velocity = mass_mean(model, body, simulation.state().reduced_momentum);
      EXPECT_LT((velocity - share * scene.gravity).norm(), 1e-12);
    }
    const EnergyBalance audit = simulation.energy_balance();
    EXPECT_NEAR(audit.energy.kinetic, 0.5 * count * share * M_PI * scene.gravity.squaredNorm(), 0.02)
        << "of (m / share) (share g)^2 / 2, m that of the polygon";
    EXPECT_NEAR(audit.energy.kinetic / audit.energy.external_work, 1, 1e-10);
  }
}

/// INDEPENDENT: steps of a layer under contact are longer, by less than the root of what was added.
TEST(RimMass, allows_longer_steps) {
  const Scene scene = small_third_body(1);
  const Model plain = build_model(scene), heavy = build_model(with_rim(scene, 2));
  const double longer = Simulation(heavy).largest_dt() / Simulation(plain).largest_dt();
  EXPECT_GT(longer, 1.15);
  EXPECT_LT(longer, std::sqrt(2.0));
}

}  // namespace
}  // namespace pliant::dynamics_tests
