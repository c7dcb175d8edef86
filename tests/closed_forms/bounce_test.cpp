// The energy error of Verlet in contact: contacts begin and end within a step (docs/notes/impacts.md).
#include <gtest/gtest.h>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double speed_before = 0.1;

/// A rigid block that falls flat on a floor without gravity: one degree of freedom, one spring while it touches.
struct Bounce {
  double square = 0;        ///< a = (w dt)^2 of the spring
  double first = 0;         ///< share of the step in touch when it meets the floor, by its speed before
  double last = 0;          ///< and when it leaves, by its speed after
  double energy_ratio = 0;  ///< after over before
};

Bounce bounce(double safety, double height) {
  Scene scene = on_a_floor(1e9, 8, 0.25, {0, 0});
  scene.shapes = {box_shape("block", 2, 1, 0.25)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{4, 0.5 + height}}, moving({0, -speed_before}))};
  scene.contacts = {frictionless(100)};
  scene.contact.energy_consistent = false;              // Verlet alone
  scene.contact.quadrature = ContactQuadrature::nodes;  // whose spring is linear
  without_error_control(scene, safety);
  const Model model = build_model(scene);
  Simulation simulation(model);
  Bounce result;
  double depth = 0;
  while (result.energy_ratio == 0) {
    const StepReport report = simulation.step(1e9);
    const State& state = simulation.state();
    const double gap = state.position.rigid[1] - 0.5, speed = state.reduced_momentum.rigid[1];
    if (gap < 0 && depth == 0) {
      result.square = report.dt * report.dt * state.force.rigid[1] * model.rigid_bodies[0].dof[1].inverse_mass / -gap;
      result.first = -gap / (speed_before * report.dt);
    }
    if (gap >= 0 && depth > 0) {
      result.last = depth / (speed * report.dt);
      result.energy_ratio = std::pow(speed / speed_before, 2);
    }
    depth = std::max(0.0, -gap);
  }
  return result;
}

/// While it touches, Verlet keeps v^2/2 + w^2 x^2/2 (1 - a/4). Between there and the free energy lies the share t of
/// the step in which the force was not yet there, or no more: a factor 1 - a t (1 - t), once down and once up. With t
/// uniform a bounce errs by a/sqrt(90) and gains a^2/180 in the mean, of the energy that its nodes bring.
TEST(Bounce, energy_changes_at_the_first_and_the_last_touch_only) {
  for (const double safety : {0.2, 0.5, 0.8, 0.9})
    for (const double height : {0.15, 0.153, 0.157, 0.161}) {
      const Bounce b = bounce(safety, height);
      const auto factor = [&](double t) { return 1 - b.square * t * (1 - t); };
      EXPECT_NEAR(b.energy_ratio, factor(b.first) / factor(b.last), 1e-9) << "EXACT, safety " << safety;
    }
}

}  // namespace
}  // namespace pliant::dynamics_tests
