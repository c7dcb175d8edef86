#include "reference/time_stepping.hpp"

#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "reference/both.hpp"
#include "support/simulations.hpp"

namespace pliant::reference_tests {
namespace {

using namespace dynamics_tests;
using reference::SolverOptions;
using reference::Vector;

double largest(const Vector& values) { return values.cwiseAbs().maxCoeff(); }

/// A rigid disc on one spring: the wall's penalty, pressed from the start, so that it never leaves.
Scene oscillator(double end) {
  Scene scene = on_a_floor(end, 8, 4, {0, -1});
  scene.shapes = {box_shape("block", 4, 1, 4)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{4, 0.49}})};
  scene.contacts = {frictionless(100)};
  scene.contact.quadrature = ContactQuadrature::nodes;  // whose spring is linear
  return scene;
}

/// Of the block two nodes, of which each stands for half of the bottom of 4 and half of a side of 1; of the floor three
/// between the block's corners, 1 apart: each half in its pass.
constexpr double touching = 0.5 * (2 * 2.5 + 3);

/// EXACT: y = s + (y0 - s) cos(w t), w^2 = kn x length / m.
double exact_height(double t) {
  const double mass = 4, stiffness = 100 * touching, rest = 0.5 - mass / stiffness;
  return rest + (0.49 - rest + 0) * std::cos(std::sqrt(stiffness / mass) * t);
}

TEST(ReferenceTimeStepping, newmark_and_hht_are_of_order_two_on_an_oscillator) {
  for (const double hht : {0.0, -0.2}) {
    std::vector<double> steps, errors;
    for (const int n : {40, 80, 160}) {
      Scene scene = oscillator(1);
      scene.gravity = {0, -1.2};  // off its rest at the start
      SolverOptions options;
      options.hht = hht;
      ReferenceRun run(scene, options);
      const double mass = 4, stiffness = 100 * touching, rest = 0.5 - 1.2 * mass / stiffness;
      const double exact = rest + (0.49 - rest) * std::cos(std::sqrt(stiffness / mass));
      steps.push_back(1.0 / n);
      errors.push_back(std::abs(run.run(n)[1] - exact));
    }
    EXPECT_NEAR(observed_order(steps, errors), 2, 0.1) << "RATE: HHT " << hht;
  }
}

/// RATE: friction is no part of it, so that only the rate of E_dot can spoil the order: halving the step quarters the
/// changes.
TEST(ReferenceTimeStepping, viscosity_is_of_order_two) {
  Scene scene = free_disc(30, 0.8, stretching(0.5));
  scene.materials[0].viscosity = 0.2;
  std::vector<Vector> ends;
  for (const int n : {10, 20, 40}) ends.push_back(run_reference(scene, n));
  EXPECT_NEAR(observed_order({2, 1}, {largest(ends[0] - ends[1]), largest(ends[1] - ends[2])}), 2, 0.15);
}

TEST(ReferenceTimeStepping, rest_is_rest) {
  ReferenceRun run(oscillator(1), {});
  EXPECT_NEAR(run.run(10)[1], exact_height(1), 1e-12);  // EXACT
}

TEST(ReferenceTimeStepping, hht_damps_what_the_step_does_not_resolve_and_newmark_does_not) {
  double kinetic_and_strain[2] = {};
  for (const bool damped : {false, true}) {
    SolverOptions options;
    options.hht = damped ? -0.3 : 0;
    ReferenceRun run(free_disc(60, 12, stretching(0.02)), options);
    run.run(80);
    kinetic_and_strain[damped] = run.stepping.balance().mechanical() / run.stepping.balance().at_start;
  }
  // RATE: Newmark's average acceleration keeps the energy of small vibrations.
  EXPECT_NEAR(kinetic_and_strain[0], 1, 2e-3);
  EXPECT_LT(kinetic_and_strain[1], 0.999);
}

TEST(ReferenceTimeStepping, a_step_that_does_not_converge_is_halved) {
  SolverOptions impatient;
  impatient.newton.iterations = 3;
  ReferenceRun run(free_disc(60, 1, stretching(1)), impatient);
  EXPECT_GE(run.stepping.step(1).bisections, 1);
  EXPECT_DOUBLE_EQ(run.stepping.motion().time, 1);
  const Vector fine = run_reference(free_disc(60, 1, stretching(1)), 64);
  EXPECT_LT(largest(run.stepping.motion().q - fine), 0.1);  // RATE: of the size of its own error, a tenth of the motion
}

TEST(ReferenceTimeStepping, a_step_that_could_miss_contacts_is_halved) {
  ReferenceRun run(flight_and_impact(1), {});  // the floor is met on the way
  EXPECT_GE(run.stepping.step(5).bisections, 1);
  EXPECT_GT(run.stepping.motion().v[1], 0);  // it bounces
}

TEST(ReferenceTimeStepping, failure_names_what_failed_and_keeps_the_last_good_state) {
  SolverOptions options;
  options.newton.iterations = 1;
  ReferenceRun run(free_disc(60, 1, stretching(40)), options);
  const Vector start = run.stepping.motion().q;
  try {
    run.stepping.step(8);
    FAIL() << "converged";
  } catch (const PhysicsError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("'disc'"), std::string::npos) << message;
    EXPECT_NE(message.find("last good state: t = 0 s"), std::string::npos) << message;
    EXPECT_EQ(error.code(), ExitCode::physics_failure);
  }
  EXPECT_EQ(run.stepping.motion().q, start);
}

TEST(ReferenceTimeStepping, static_block_under_gravity) {
  Scene scene = oscillator(1);
  SolverOptions options;
  options.statics = true;
  scene.gravity = {0, -1.5};
  ReferenceRun run(scene, options);
  // EXACT: weight over stiffness. It may slide freely, so that the tangent is singular.
  EXPECT_NEAR(run.run(2)[1], 0.5 - 1.5 * 4 / (100 * touching), 1e-10);
}

TEST(ReferenceTimeStepping, a_static_body_that_nothing_holds_is_refused) {
  SolverOptions options;
  options.statics = true;
  Scene scene = free_disc(60, 1);
  scene.gravity = {0, -1};
  ReferenceRun run(scene, options);
  try {
    run.run(1);
    FAIL() << "converged";
  } catch (const PhysicsError& error) {
    EXPECT_NE(std::string(error.what()).find("pseudo-transient continuation"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace pliant::reference_tests
