// Heat of bodies: what dissipates is shared out completely, and each share goes to its body.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "dynamics/body_heat.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double capacity = 2.5;

Scene plastic_disc(double share) {
  Scene scene = free_disc(60, 1e9, stretching(0.4));
  Material& material = scene.materials[0] = elastic();
  material.law = MaterialLaw::von_mises, material.yield = 0.03, material.hardening = 0.02;
  material.heat_capacity = capacity, material.taylor_quinney = share;
  return scene;
}

void run_to(Simulation& simulation, double time) {
  while (simulation.state().time < time) simulation.step(time);
}

// EXACT: a disc that nothing touches takes its share of the plastic loss, with both integrators, in lanes and nodewise.
TEST(BodyHeat, is_the_share_of_the_plastic_loss) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::step_doubling})
    for (const int least_nodes : {0, 1 << 30}) {
      Scene scene = plastic_disc(0.8);
      scene.time.integrator = integrator;
      BuildOptions options;
      options.least_sparse_nodes = least_nodes;
      const Model model = build_model(scene, options);
      Simulation simulation(model);
      run_to(simulation, 1);
      const double loss = simulation.state().plastic_loss, heat = simulation.state().memory.heat[0];
      EXPECT_GT(loss, 1e-3);
      EXPECT_NEAR(heat, 0.8 * loss, 1e-13 * loss);
      EXPECT_NEAR(temperature_rise(model, 0, simulation.state().memory.heat), heat / (model.bodies[0].mass * capacity),
                  1e-15);
    }
}

// RATE: viscosity heats by what it dissipates, but for the first order of the steps. The first steps of a run, which
// the safety hardly changes, do not count.
TEST(BodyHeat, is_what_viscosity_dissipates) {
  double errors[2];
  for (int i = 0; i < 2; ++i) {
    Scene scene = free_disc(60, 1e9, stretching(0.4));
    scene.materials[0] = elastic();
    scene.materials[0].viscosity = 0.05, scene.materials[0].heat_capacity = capacity;
    scene.time.safety = 0.4 / (1 << i), scene.time.tolerance = 1;
    const Model model = build_model(scene);
    Simulation simulation(model);
    run_to(simulation, 0.2);
    const double heat = simulation.state().memory.heat[0], dissipated = simulation.state().dissipated;
    run_to(simulation, 1);
    errors[i] = std::abs((simulation.state().memory.heat[0] - heat) / (simulation.state().dissipated - dissipated) - 1);
  }
  EXPECT_LT(errors[0], 0.05);
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 1, 0.3) << errors[0] << " " << errors[1];
}

// EXACT: a block that slides on a floor shares the work of friction with it by halves.
TEST(BodyHeat, of_contact_is_shared_by_halves) {
  Scene scene = on_a_floor(1000, 20, 0.1, {0.2, -1});
  scene.shapes = {box_shape("block", 1, 0.5, 0.1)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{10, 0.245}}, moving({3, 0}))};
  scene.contacts = {mohr_coulomb(100, 0.5)};
  for (Material& material : scene.materials) material.heat_capacity = capacity;
  const Model model = build_model(scene);
  Simulation simulation(model);
  run_to(simulation, 0.5);
  const std::vector<double>& heat = simulation.state().memory.heat;
  const double work = simulation.state().dissipated;
  EXPECT_GT(work, 0.1);
  EXPECT_NEAR(heat[0], heat[1], 1e-13 * work);
  EXPECT_NEAR(heat[0] + heat[1], work, 1e-13 * work);
}

// EXACT: without a heat capacity nothing is kept, and the rise of a body without one is no number.
TEST(BodyHeat, is_kept_on_request) {
  Scene scene = plastic_disc(0.9);
  scene.materials[0].heat_capacity = 0;
  const Model model = build_model(scene);
  Simulation simulation(model);
  run_to(simulation, 0.1);
  EXPECT_TRUE(simulation.state().memory.heat.empty());
  EXPECT_TRUE(std::isnan(temperature_rise(model, 0, simulation.state().memory.heat)));
}

}  // namespace
}  // namespace pliant::dynamics_tests
