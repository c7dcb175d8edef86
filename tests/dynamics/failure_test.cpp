// How a run that cannot go on ends: where, when, why, and what the last good state is (docs/design.md 5).
#include "dynamics/failure.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "bodies/internal_forces.hpp"
#include "core/errors.hpp"
#include "setup/build_model.hpp"
#include "support/bench.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The message of the PhysicsError that an action ends with.
template <class Action>
std::string failure_of(Action&& action) {
  try {
    action();
  } catch (const PhysicsError& error) {
    EXPECT_EQ(error.code(), ExitCode::physics_failure);
    return error.what();
  }
  ADD_FAILURE() << "nothing thrown";
  return {};
}

std::string failure_of_run(const Scene& scene) {
  const Model model = build_model(scene);
  Simulation simulation(model);
  return failure_of([&] { advance(simulation, scene.time.end); });
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), std::string::npos) << "no '" << word << "' in: " << text;
}

TEST(Failure, time_step_under_its_floor_says_so) {
  Scene scene = free_disc(40, 10, stretching(0.1));
  scene.time.tolerance = 1e-60;  // below rounding: no step can meet it
  expect_words(failure_of_run(scene), {"error", "time step", "rejected", "disc (contact 0 % of w^2)",
                                       "t = ", "last good state: step 0, t = 0 s"});
  scene.time.integrator = Integrator::step_doubling;
  scene.time.target = 1e-60;
  expect_words(failure_of_run(scene), {"error", "time step", "error control", "t = ", "last good state"});
}

/// A floor too soft to stop the disc within a segment length: contacts would be lost, and no smaller step helps.
TEST(Failure, stops_at_the_last_good_state) {
  Scene scene = flight_and_impact(1e-2);
  scene.contacts = {frictionless(1)};
  const Model model = build_model(scene);
  Simulation simulation(model);
  State before;
  const std::string message = failure_of([&] {
    while (simulation.state().time < 8) {
      before = simulation.state();
      simulation.step(8);
    }
  });
  expect_words(message,
               {"contact between body", "'disc'", "'floor'", "outline node", "penetration", "stiffness",
                "t = ", "of w^2", fmt::format("last good state: step {}, t = {:.6g} s", before.steps, before.time)});
  EXPECT_GT(before.time, 2) << "the gap of 0.5 closes at 2.5";
  EXPECT_LT(before.time, 8);
  EXPECT_EQ(simulation.state().time, before.time) << "EXACT";
  EXPECT_EQ(mass_mean(model, model.bodies[0], simulation.state().position),
            mass_mean(model, model.bodies[0], before.position))
      << "EXACT";
  EXPECT_TRUE(std::isfinite(simulation.energy_balance().energy.mechanical()));
}

/// Evaluates a bench's forces for what a test did to its positions and lets the failure be told.
std::string failure_at(Bench& bench) {
  Trial trial(bench.model);
  const Evaluation evaluation = bench.evaluate(trial);
  bench.state.force = trial.force;
  return failure_of([&] { check_start(evaluation, bench.state, bench.forces); });
}

double& component(Bench& bench, Dofs& dofs, int body, int node, int c) {
  const Body& b = bench.model.bodies[body];
  const std::size_t at = bench.model.batches[b.batch].offset + 2 * static_cast<std::size_t>(node) + c;
  return reinterpret_cast<double*>(&dofs.compliant[at])[b.lane];
}

/// Of ten discs the seventh has one node pushed through to its other side.
TEST(Failure, inverted_grain_is_named_with_its_point) {
  Scene scene = free_disc(40, 10);
  scene.grains[0].packing.positions.clear();
  for (int i = 0; i < 10; ++i) scene.grains[0].packing.positions.push_back({3.0 * i, 0});
  Bench bench(scene);
  const int victim = 6, node = 39;
  component(bench, bench.state.position, victim, node, 0) += 0.8;
  const Body& body = bench.model.bodies[victim];
  const auto F = deformation_gradients(bench.model, body, bench.state.position);
  std::size_t worst = 0;
  for (std::size_t g = 1; g < F.size(); ++g)
    if (determinant(F[g]) < determinant(F[worst])) worst = g;
  ASSERT_LT(determinant(F[worst]), 0);
  expect_words(failure_at(bench), {"body 6 'disc 6'", fmt::format("J = {:.3g} <= 0", determinant(F[worst])),
                                   fmt::format("integration point {} of {}", worst, F.size()), "reference shape"});
}

TEST(Failure, numbers_that_are_none_are_named) {
  Scene scene = flight_and_impact(1e-2);
  scene.grains.push_back(grains("stone", "disc", BodyKind::rigid, {{1, 5}, {1, 8}}));
  const auto message = [&](auto spoil) {
    Bench bench(scene);
    spoil(bench);
    return failure_of([&] { check_start({}, bench.state, bench.forces); });
  };
  expect_words(message([](Bench& b) { component(b, b.state.position, 0, 7, 1) = NAN; }),
               {"position", "node 7", "reference shape", "body 0 'disc'", "not a number"});
  expect_words(message([](Bench& b) { component(b, b.state.force, 0, 9, 0) = infinity; }),
               {"force", "node 9", "body 0 'disc'", "infinite"});
  expect_words(message([](Bench& b) { b.state.force.rigid[5] = NAN; }), {"force", "the angle", "body 2 'stone 1'"});
}

TEST(Failure, initial_overlap_is_named) {
  Scene scene = flight_and_impact(1e-2);
  scene.grains[0].packing.positions = {{4, 0.9}};
  Bench bench(scene);
  Evaluation lost;
  lost.contact_lost = true, lost.valid = false;
  expect_words(failure_of([&] { check_start(lost, bench.state, bench.forces); }),
               {"contact between body", "'disc'", "'floor'", "penetration", "initial overlaps", "at the start"});
}

/// EXACT: where contact is lost as segments are squeezed the advice is another one, from half their length on.
TEST(Failure, squeezed_segments_are_told) {
  Scene scene = empty_scene(1);
  scene.shapes = {box_shape("block", 1, 1, 0.1)};
  scene.grains = {grains("lower", "block", BodyKind::rigid, {{0, 0}}),
                  grains("upper", "block", BodyKind::rigid, {{0, 0.98}})};
  const auto message = [&](double length) {
    Bench bench(scene);
    for (int k = bench.model.outline_offset[0]; k < bench.model.outline_offset[1]; ++k)
      bench.state.outlines.position.x[k] *= length;
    Evaluation lost;
    lost.contact_lost = true, lost.valid = false;
    return failure_of([&] { check_start(lost, bench.state, bench.forces); });
  };
  expect_words(message(0.45), {"squeezed to 0.45", "more nodes"});
  expect_words(message(0.55), {"raise the contact stiffness"});
}

/// The first trial after a free flight may turn a grain inside out: it is a step too long, not the end of the run.
TEST(Failure, a_trial_that_inverts_a_grain_is_rejected) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::step_doubling}) {
    Scene scene = flight_and_impact(1e-2);
    scene.contacts = {frictionless(1e4)};
    scene.grains[0].velocity.uniform = {0, -0.5};
    scene.time.integrator = integrator;
    const Model model = build_model(scene);
    Simulation simulation(model);
    EXPECT_NO_THROW(advance(simulation, 4));
    EXPECT_GT(mass_mean(model, model.bodies[0], simulation.state().reduced_momentum).y(), 0.1) << "EXACT: it bounced";
  }
}

}  // namespace
}  // namespace pliant::dynamics_tests
