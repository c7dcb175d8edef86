// Options of contact: refresh at fixed times, present lengths, a smooth start of the pressure, law by law as the scene
// has them.
#include <gtest/gtest.h>

#include <functional>

#include "setup/build_model.hpp"
#include "support/bench.hpp"
#include "support/contact_rig.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

/// EXACT: candidates are found every so many steps, or every so much time, and not for any motion between.
TEST(FixedRefresh, keeps_its_period) {
  const auto refreshes = [](int steps, double period) {
    Scene scene = on_a_floor(1, 8, 0.25, {0, -1});
    scene.shapes = {box_shape("block", 2, 1, 0.25)};
    scene.grains = {grains("block", "block", BodyKind::rigid, {{4, 0.495}}, moving({1, 0}))};
    scene.contact.refresh_steps = steps, scene.contact.refresh_period = period;
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 1);
    return std::pair(simulation.forces().contact().refreshes(), simulation.state().steps);
  };
  const auto [by_steps, steps] = refreshes(7, 0);
  EXPECT_EQ(by_steps, 1 + (steps - 1) / 7);
  EXPECT_EQ(refreshes(1, 0).first, refreshes(1, 0).second);
  const long by_time = refreshes(0, 0.1).first;
  EXPECT_GE(by_time, 9);
  EXPECT_LE(by_time, 11);
}

/// EXACT: often enough, it sees all that the safe refresh sees. Equal steps, as the bound of the step is looked up at
/// each refresh; without the energy correction of pairs that have parted, by as many nodes as the last search found.
TEST(FixedRefresh, often_enough_changes_nothing) {
  const auto position = [](int refresh_steps) {
    Scene scene = flight_and_impact(1e300);
    scene.contacts = {mohr_coulomb(300, 0.3)};
    scene.contact.refresh_steps = refresh_steps;
    scene.contact.energy_consistent = false;
    Bench bench(scene);
    Verlet integrator(bench.forces, bench.state);
    bench.control.next_dt = 1e9;
    for (int i = 1; i <= 1500; ++i) take_step(integrator, bench.forces, bench.state, bench.control, 0.004 * i);
    EXPECT_EQ(bench.state.steps, 1500);
    return mass_mean(bench.model, bench.model.bodies[0], bench.state.position);
  };
  EXPECT_LT((position(3) - position(0)).norm(), 1e-12) << "orders of sums may differ";
}

/// A too long period misses contacts, as is said: the block falls through.
TEST(FixedRefresh, too_seldom_misses_contacts) {
  Scene scene = on_a_floor(8, 8, 0.25, {0, 0});
  scene.shapes = {box_shape("block", 2, 1, 0.25)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{4, 2.5}}, moving({0, -1}))};
  scene.contact.refresh_period = 100;
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 4);
  EXPECT_NEAR(simulation.state().position.rigid[1], -1.5, 1e-12) << "EXACT: free flight";
}

/// A compliant block 1 x 0.5, its nodes moved to the right by stretch(X), pressed by `depth` into a rigid plate of
/// nodes every `spacing`.
struct StretchedBlock {
  static constexpr double stiffness = 100, depth = 0.01;
  testing::ContactRig rig;

  StretchedBlock(double spacing, const std::function<double(double)>& stretch) : rig(scene(spacing)) {
    const Batch& batch = rig.model.batches[0];
    for (int i = 0; i < rig.model.shape_of(batch).nodes(); ++i) {
      Lanes& x = rig.q.compliant[batch.offset + 2 * i];
      x += broadcast(stretch(x[0]));
    }
    rig.move(1, {0, -depth});
    rig.evaluate();
  }
  static Scene scene(double spacing) {
    Scene scene = testing::nodal_scene();
    scene.contacts = {testing::frictionless(stiffness)};
    scene.contact.length = ContactLength::current;
    testing::add_body(scene, testing::outline_shape("plate", testing::rectangle(3, 0.5, spacing)), BodyKind::rigid,
                      {0, -0.25});
    testing::add_body(scene, testing::outline_shape("block", testing::rectangle(1, 0.5, 0.1), 60), BodyKind::compliant,
                      {0, 0.25});
    return scene;
  }
};

/// EXACT: half of its two segments as they are now for each node of the lower face but its corners, that have a side as
/// well. The plate's nodes are far away, so that the block's own pass is all there is.
TEST(CurrentLength, is_half_of_the_two_present_segments) {
  const StretchedBlock block(3, [](double x) { return x * (0.1 + 0.3 * x); });
  double narrowest = 1, widest = 0;
  for (int k = 1; k < 10; ++k) {
    const double length = 0.5 * (block.rig.node(1, k + 1) - block.rig.node(1, k - 1)).x();
    EXPECT_NEAR(block.rig.force(1, k).y(), 0.5 * block.stiffness * block.depth * length, 1e-13) << "node " << k;
    narrowest = std::min(narrowest, length), widest = std::max(widest, length);
  }
  EXPECT_GT(widest, 1.5 * narrowest) << "else one segment would do for the other";
}

/// EXACT: a face stretched by a tenth carries the pressure on its present length. The face ends midway between nodes of
/// the plate, whose nodes below it have its length in all.
TEST(CurrentLength, of_a_stretched_face_carries_its_pressure) {
  const StretchedBlock block(0.1, [](double x) { return 0.1 * x; });
  // Of the block 11 nodes, of which those at the corners stand for half of a side's segment of 0.1.
  EXPECT_NEAR(block.rig.force(1).y(), block.stiffness * block.depth * 0.5 * (1.1 + 1.2), 1e-12);
}

/// RATE: what the present length costs in energy, 0.05 to 0.3 % in a prototype; the reference length keeps it to the
/// integrator's error.
TEST(CurrentLength, costs_energy) {
  const auto error = [](ContactLength length) {
    Scene scene = flight_and_impact(1e-2);
    scene.time.safety = 0.2;
    scene.contact.length = length;
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 6);
    return simulation.balance_error(simulation.energy_balance().energy);
  };
  const double reference = error(ContactLength::reference), current = error(ContactLength::current);
  RecordProperty("reference", std::to_string(reference));
  RecordProperty("current", std::to_string(current));
  EXPECT_LT(reference, 3e-4);
  EXPECT_GT(current, 3 * reference);
  EXPECT_LT(current, 2e-2);
}

/// Velocity of a compliant disc after a bounce on a floor, in so many equal steps.
Vec2 after_bounce(double smoothing, int steps) {
  Scene scene = flight_and_impact(1e300);
  scene.grains[0].packing.positions[0] = Vec2(4, 1.05);
  scene.contacts[0].smoothing = smoothing;
  scene.contact.energy_consistent = false;  // Verlet alone
  Bench bench(scene);
  Verlet integrator(bench.forces, bench.state);
  bench.control.next_dt = 1e9;
  for (int i = 1; i <= steps; ++i) take_step(integrator, bench.forces, bench.state, bench.control, 4.0 * i / steps);
  EXPECT_EQ(bench.state.steps, steps);
  const Vec2 velocity = mass_mean(bench.model, bench.model.bodies[0], bench.state.reduced_momentum);
  EXPECT_GT(velocity.y(), 0.1) << "it must have bounced";
  return velocity;
}

/// RATE: Verlet's second order once the steps resolve the smooth start of the pressure. With a sudden one the errors of
/// these steps fall by anything between 0.2 and 16 from halving to halving.
TEST(SmoothStart, gives_second_order) {
  const Vec2 exact = after_bounce(0.02, 12800);
  const double coarse = (after_bounce(0.02, 800) - exact).norm(), middle = (after_bounce(0.02, 1600) - exact).norm(),
               fine = (after_bounce(0.02, 3200) - exact).norm();
  EXPECT_NEAR(observed_order(coarse, middle), 2, 0.2);
  EXPECT_NEAR(observed_order(middle, fine), 2, 0.2) << "the reference's own error is a sixteenth of the last";
}

}  // namespace
}  // namespace pliant::dynamics_tests
