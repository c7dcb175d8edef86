// What probes show does not depend on which others there are, nor on audits between.
#include <gtest/gtest.h>

#include "setup/build_model.hpp"
#include "support/probing.hpp"

namespace pliant::dynamics_tests {
namespace {

/// A rigid block that has just met a floor through a dashpot, whose force goes with the velocity.
Scene damped_block() {
  Scene scene = on_a_floor(1, 8, 0.25, {0, 0});
  scene.shapes = {box_shape("block", 2, 1, 0.25)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{4, 0.503}}, moving({0, -0.1}))};
  scene.contacts[0].restitution = 0.3;
  without_error_control(scene, 0.8);
  return scene;
}

/// EXACT: bit by bit. Audits evaluate the forces at the velocities of the step's end, the step itself at its middle.
TEST(ProbeOrder, does_not_matter) {
  const Model model = build_model(damped_block());
  Simulation simulation(model);
  while (contact_force(simulation, 0).norm() == 0) simulation.step(1);
  const std::vector<double> first = measured(simulation, probe_of("force", "block"));
  ASSERT_GT(first[1], 0);
  const std::vector<double> energy = measured(simulation, probe_of("energy"));
  EXPECT_EQ(measured(simulation, probe_of("force", "block")), first);
  EXPECT_EQ(measured(simulation, probe_of("energy")), energy);
}

/// EXACT: the force that probes show is the one that the next step starts with.
TEST(ProbeOrder, shows_the_force_of_the_step) {
  const Model model = build_model(damped_block());
  Simulation simulation(model);
  while (contact_force(simulation, 0).norm() == 0) simulation.step(1);
  simulation.energy_balance();
  EXPECT_NEAR(measured(simulation, probe_of("force", "block"))[1], simulation.state().force.rigid[1], 1e-12)
      << "sums in another order";
}

/// EXACT: outputs after a step in which candidates were found anew see the present lengths, not those of the start of
/// it.
TEST(CurrentLength, is_that_of_the_accepted_positions) {
  Scene scene = flight_and_impact(1e-2);
  scene.contact.length = ContactLength::current;
  scene.contact.refresh_steps = 3;
  const Model model = build_model(scene);
  Simulation simulation(model);
  while (simulation.state().time < 3) {
    simulation.step(3);
    const Outlines& outlines = simulation.state().outlines;
    const OutlineField& o = outlines.position;
    const int n = model.outline_of(0).count;
    for (int i = 1; i < n; ++i) {
      const auto length = [&](int a, int b) { return std::hypot(o.x[b] - o.x[a], o.y[b] - o.y[a]); };
      ASSERT_EQ(outlines.tributary_length[i], 0.5 * (length(i - 1, i) + length(i, i + 1))) << simulation.state().steps;
    }
  }
}

}  // namespace
}  // namespace pliant::dynamics_tests
