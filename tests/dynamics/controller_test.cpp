// What sets Verlet's steps when the error does, and how a run that cannot go on ends (METHOD 6, DESIGN 5).
#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "support/bench.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

/// A compliant disc that flies freely and then hits a fixed wall.
Scene flight_and_impact(double tolerance) {
  Scene scene = on_a_floor(8, 8, 0.25, {0, 0});
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("disc", "disc", BodyKind::compliant, {{4, 1.5}}, moving({0, -0.2}))};
  scene.contacts = {smooth(300)};
  scene.time.tolerance = tolerance;
  return scene;
}

TEST(Controller, factors_stay_within_their_clamps) {
  const Model model = build_model(flight_and_impact(1e-5));
  Simulation simulation(model);
  double before = simulation.step(1e9).dt;
  std::int64_t rejections = 0;
  while (simulation.state().time < 8) {
    const double largest = simulation.largest_dt();
    const StepReport report = simulation.step(1e9);
    rejections += report.rejections;
    EXPECT_LE(report.dt, 1.15 * before * std::pow(0.9, report.rejections) * (1 + 1e-12))
        << "EXACT, t = " << simulation.state().time;
    EXPECT_GE(report.dt, std::min(0.5 * before, largest) * std::pow(0.5, report.rejections) * (1 - 1e-12)) << "EXACT";
    before = report.dt;
  }
  EXPECT_GT(rejections, 0) << "the impact must be felt, or this test says nothing";
}

TEST(Controller, no_accepted_step_exceeds_twice_the_tolerance) {
  const Model model = build_model(flight_and_impact(1e-5));
  Simulation simulation(model);
  while (simulation.state().time < 8) EXPECT_LE(simulation.step(1e9).error, 2e-5) << "EXACT";
  EXPECT_GT(simulation.state().rejections, 0);
}

/// The estimate is dt^2 |a_new - a_old|/(6 d), here from the states before and after a step.
TEST(Controller, error_is_the_documented_estimate) {
  const Model model = build_model(flight_and_impact(1e-4));
  Simulation simulation(model);
  advance(simulation, 3.5);  // in contact
  const Body& disc = model.bodies[0];
  const std::vector<double> masses = node_masses(model, disc);
  const std::vector<double>& distance = model.shape_of(model.batches[disc.batch]).space.nodal_distance;
  const Dofs before = simulation.state().force;
  const StepReport report = simulation.step(1e9);
  double expected = 0;
  for (int i = 0; i < static_cast<int>(masses.size()); ++i) {
    const Vec2 change = node_value(model, disc, simulation.state().force, i) - node_value(model, disc, before, i);
    expected = std::max(expected, report.dt * report.dt * change.cwiseAbs().maxCoeff() / masses[i] / (6 * distance[i]));
  }
  EXPECT_GT(expected, 0);
  EXPECT_NEAR(report.error, expected, 1e-12 * expected) << "EXACT";
}

/// A step cut short by an output must not slow the run down: the next one is at least half of what was proposed before.
TEST(Controller, short_steps_before_outputs_are_made_good) {
  const Model model = build_model(free_disc(40, 10, stretching(0.1)));
  Simulation simulation(model);
  advance(simulation, 5);
  const double proposed = simulation.state().next_dt;
  simulation.step(simulation.state().time + 1e-4 * proposed);
  EXPECT_GE(simulation.state().next_dt, 0.5 * proposed) << "EXACT";
  const StepReport report = simulation.step(1e9);
  EXPECT_GE(report.dt, 0.5 * proposed) << "EXACT";
}

/// The message of the PhysicsError that ends a run.
std::string failure_of(const Scene& scene) {
  const Model model = build_model(scene);
  Simulation simulation(model);
  try {
    advance(simulation, scene.time.end);
  } catch (const PhysicsError& error) {
    EXPECT_EQ(error.code(), ExitCode::physics_failure);
    return error.what();
  }
  ADD_FAILURE() << "the run went on to its end";
  return {};
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), std::string::npos) << "no '" << word << "' in: " << text;
}

TEST(Failure, time_step_under_its_floor_says_so) {
  Scene scene = free_disc(40, 10, stretching(0.1));
  scene.time.tolerance = 1e-60;  // below rounding: no step can meet it
  expect_words(failure_of(scene), {"time step", "t = ", "error"});
  scene.time.integrator = Integrator::step_doubling;
  scene.time.target = 1e-60;
  expect_words(failure_of(scene), {"time step", "t = ", "error"});
}

/// A floor too soft to stop the disc within a segment length: contacts would be lost, and no smaller step helps.
TEST(Failure, stops_at_the_last_good_state) {
  Scene scene = flight_and_impact(1e-2);
  scene.contacts = {smooth(1)};
  const Model model = build_model(scene);
  Simulation simulation(model);
  State before;
  const auto run = [&] {
    while (simulation.state().time < 8) {
      before = simulation.state();
      simulation.step(8);
    }
    ADD_FAILURE() << "the run went on to its end";
  };
  try {
    run();
  } catch (const PhysicsError& error) {
    expect_words(error.what(), {"penetration", "t = ", "stiffness"});
  }
  EXPECT_GT(before.time, 2) << "the gap of 0.5 closes at 2.5";
  EXPECT_LT(before.time, 8);
  EXPECT_EQ(simulation.state().time, before.time) << "EXACT";
  EXPECT_EQ(mass_mean(model, model.bodies[0], simulation.state().position),
            mass_mean(model, model.bodies[0], before.position))
      << "EXACT";
  EXPECT_TRUE(std::isfinite(simulation.audit().energy.mechanical()));
}

TEST(Failure, inverted_grain_is_named_with_its_time) {
  Scene scene = free_disc(40, 10);
  scene.grains[0].name = "victim";
  Bench bench(scene);
  for (std::size_t i = 0; i < bench.state.position.compliant.size(); i += 2) bench.state.position.compliant[i] *= -0.3;
  ContactHistory trial;
  const Evaluation evaluation =
      bench.forces.evaluate(bench.state.position, 2.5, bench.state.history, trial, bench.state.force);
  EXPECT_FALSE(evaluation.sound);
  EXPECT_NEAR(evaluation.least_jacobian, -0.3, 1e-12) << "EXACT: linear completeness";
  try {
    bench.forces.check(evaluation, 2.5);
    ADD_FAILURE() << "nothing thrown";
  } catch (const PhysicsError& error) {
    expect_words(error.what(), {"J = -0.3", "victim", "t = 2.5"});
  }
}

/// The first trial after a free flight may turn a grain inside out: it is a step too long, not the end of the run.
TEST(Failure, a_trial_that_inverts_a_grain_is_rejected) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::step_doubling}) {
    Scene scene = flight_and_impact(1e-2);
    scene.contacts = {smooth(1e4)};
    scene.grains[0].velocity.uniform = {0, -0.5};
    scene.time.integrator = integrator;
    const Model model = build_model(scene);
    Simulation simulation(model);
    EXPECT_NO_THROW(advance(simulation, 4));
    EXPECT_GT(mass_mean(model, model.bodies[0], simulation.state().velocity).y(), 0.1) << "EXACT: it bounced";
  }
}

}  // namespace
}  // namespace pliant::dynamics_tests
