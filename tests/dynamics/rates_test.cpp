// Forces that depend on velocities are of second order in the step, and so are their energy balance; mass damping by
// itself is exact.
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>

#include "contact/law_table.hpp"
#include "dynamics/mass_damping.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"
#include "support/steered.hpp"

namespace pliant::dynamics_tests {
namespace {

/// EXACT: the integrals of exp(-c t), beside their series and where exp(-z) is nothing.
TEST(MassDamping, over_a_step) {
  const DampedStep<double> none = damped_step(0.0);
  EXPECT_EQ(none.mean, 0.5);
  EXPECT_EQ(none.end, 1);
  for (const double z : {1e-9, 1e-3, 0.3, 0.999, 1.001, 7.0, 400.0}) {
    const DampedStep<double> damped = damped_step(z);
    EXPECT_NEAR(damped.end * z / -std::expm1(-z), 1, 1e-14);
    EXPECT_NEAR(damped.mean * z + damped.end, 1, 1e-14) << "the way and the speed of a body that nothing pushes";
  }
}

Scene falling(double rate, Mass mass) {
  Scene scene = empty_scene(3);
  scene.gravity = {0.2, -1};
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("soft", "disc", BodyKind::compliant, {{0, 0}}, moving({0.5, 0.7})),
                  grains("hard", "disc", BodyKind::rigid, {{10, 0}}, moving({0.5, 0.7}, 1.5))};
  for (Material& material : scene.materials) material.mass_damping = rate;
  scene.discretisation.mass = mass;
  return scene;
}

/// EXACT: v = g/c + (v0 - g/c) exp(-c t) at default settings, in steps of whatever size, and what is lost is accounted
/// for.
TEST(MassDamping, of_falling_bodies_is_exact) {
  for (const double rate : {0.4, 30.0})
    for (const Mass mass : {Mass::lumped, Mass::corrected}) {
      const Model model = build_model(falling(rate, mass));
      Simulation simulation(model);
      advance(simulation, 3);
      const Vec2 last = Vec2(0.2, -1) / rate, start(0.5, 0.7);
      const double left = std::exp(-3 * rate);
      const Vec2 speed = last + left * (start - last), way = 3 * last + (1 - left) / rate * (start - last);
      const State& state = simulation.state();
      EXPECT_LT((rigid(state.reduced_momentum, 0).head<2>() - speed).norm(), 1e-12);
      EXPECT_LT((rigid(state.position, 0).head<2>() - Vec2(10, 0) - way).norm(), 1e-12);
      EXPECT_NEAR(rigid(state.position, 0)[2], 1.5 * (1 - left) / rate, 1e-12);
      EXPECT_LT((mass_mean(model, model.bodies[0], state.reduced_momentum) - speed).norm(), 1e-11);
      EXPECT_LT(simulation.balance_error(simulation.energy_balance().energy), 1e-11);
      EXPECT_GT(simulation.energy_balance().energy.dissipated, 0.1);
    }
}

/// Mass damping alone sets no limit: a rigid body that nothing else moves takes the run in few steps.
TEST(MassDamping, limits_no_step) {
  Scene scene = falling(1000, Mass::lumped);
  scene.grains.erase(scene.grains.begin());
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 3);
  EXPECT_LT(simulation.state().steps, 100);
  EXPECT_NEAR(rigid(simulation.state().reduced_momentum, 0)[1], -1e-3, 1e-14)
      << "EXACT: no ringing about the last speed";
}

/// What a run in equal steps comes to.
struct Run {
  State state;
  double imbalance = 0;  ///< the largest, J/m
};

Run run_equal_steps(const Scene& scene, int steps) {
  Steered here(build_model(scene));
  Run result;
  for (int i = 1; i <= steps; ++i) {
    here.bench.control.next_dt = 1e300;
    const StepReport report =
        take_step(*here.verlet, here.bench.forces, here.bench.state, here.bench.control, scene.time.end * i / steps);
    EXPECT_NEAR(report.dt * steps / scene.time.end, 1, 1e-9) << "the step is stable";
    result.imbalance =
        std::max(result.imbalance, std::abs(here.auditor.energy_gained(here.auditor.audit(here.bench.state).energy)));
  }
  result.state = here.bench.state;
  return result;
}

/// Errors over three halvings of the step.
void expect_second_order(const std::vector<double>& errors) {
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_NEAR(observed_order(errors[i - 1], errors[i]), 2, 0.2) << "RATE: " << errors[i - 1] << " to " << errors[i];
}

constexpr int steps[] = {200, 400, 800};

/// x'' = -w^2 x - 2 z w x' from x, v at the start: x at t.
double damped_swing(double w, double z, double x, double v, double t) {
  const std::complex<double> root = std::sqrt(std::complex<double>(z * z - 1)), fast = w * (-z - root),
                             slow = w * (-z + root);
  return (((slow * x - v) * std::exp(fast * t) - (fast * x - v) * std::exp(slow * t)) / (slow - fast)).real();
}

/// Of the first degree of freedom y of a rigid body that swings about its equilibrium on a contact spring. `pull`: of a
/// force other than spring and dashpot; `rate`: coefficient of the dashpot over the mass, 1/s, as a function of w.
template <class Rate>
void expect_swing(Scene scene, std::size_t rigid_body, double depth, double pull, Rate&& rate) {
  without_error_control(scene, 0.9);
  scene.contact.quadrature = ContactQuadrature::nodes;  // whose spring is linear
  const std::size_t at = 3 * rigid_body + 1;
  std::vector<double> errors, imbalances;
  for (const int count : steps) {
    const Bench start(scene);
    const double mass = start.model.rigid_bodies[rigid_body].dof[1].mass;
    const double w2 = (start.state.force.rigid[at] - pull) / mass / depth, w = std::sqrt(w2);
    const double rest = pull / mass / w2;  // of the equilibrium above the undeformed place
    const Run end = run_equal_steps(scene, count);
    const double moved = end.state.position.rigid[at] - start.state.position.rigid[at];
    const double x0 = -depth - rest;
    errors.push_back(std::abs(moved + x0 - damped_swing(w, rate(w) / (2 * w), x0, 0, scene.time.end)));
    imbalances.push_back(end.imbalance);
    EXPECT_GT(end.state.damped, 1e-6);
  }
  expect_second_order(errors);
  expect_second_order(imbalances);
}

/// A block on a floor that it never leaves.
TEST(Rate, of_contact_dashpots) {
  Scene scene = on_a_floor(1, 8, 0.25, {0, -1});
  scene.shapes = {box_shape("block", 2, 1, 0.25)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{4, 0.495}})};
  scene.contacts = {frictionless(100)};
  scene.contacts[0].restitution = 0.5;
  scene.contacts[0].pull = true;
  expect_swing(scene, 0, 0.005, -2, [](double w) { return 2 * damping_ratio(0.5, true) * w; });
}

/// A lid under a pressure and its dashpot, on a block that is held.
TEST(Rate, of_dashpots_beside_loads) {
  Scene scene = empty_scene(1);
  scene.period = 8;
  scene.shapes = {box_shape("block", 2, 1, 0.25)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{4, 0.505}})};
  BoundaryCondition held;
  held.grains = "block";
  held.x.mode = held.y.mode = held.angle.mode = AxisCondition::Mode::fixed;
  scene.boundary = {held};
  scene.walls = {flat_wall("lid", Wall::Solid::above, 1, 0.25, 0.25)};
  scene.walls[0].y = {AxisCondition::Mode::pressure, constant(0.25), 1};
  scene.contacts = {frictionless(100)};
  expect_swing(scene, 1, 0.005, -2, [](double) { return 1 * 8 / 2.0; });
}

/// Against steps a sixteenth of the finest, which leaves 1/256 of the error.
void expect_second_order_of(Scene scene) {
  without_error_control(scene, 0.9);
  const State exact = run_equal_steps(scene, 16 * steps[2]).state;
  std::vector<double> errors, imbalances;
  for (const int count : steps) {
    const Run end = run_equal_steps(scene, count);
    errors.push_back(distance(end.state, exact));
    imbalances.push_back(end.imbalance);
    EXPECT_GT(end.state.damped, 1e-3);
  }
  expect_second_order(errors);
  expect_second_order(imbalances);
}

Scene stretched_disc(Mass mass) {
  Scene scene = free_disc(40, 4, stretching(0.2));
  scene.discretisation.mass = mass;
  return scene;
}

TEST(Rate, of_mass_damping) {
  for (const Mass mass : {Mass::lumped, Mass::corrected}) {
    Scene scene = stretched_disc(mass);
    scene.materials[0].mass_damping = 0.7;
    expect_second_order_of(scene);
  }
}

TEST(Rate, of_viscosity) {
  for (const Mass mass : {Mass::lumped, Mass::corrected}) {
    Scene scene = stretched_disc(mass);
    scene.materials[0].viscosity = 0.05;
    expect_second_order_of(scene);
  }
}

/// With a target that moves, and that sets in and ends where no equal step would.
TEST(Rate, of_supports_dashpots) {
  Scene scene = stretched_disc(Mass::lumped);
  BoundaryCondition support;
  support.kind = BoundaryCondition::Kind::support;
  support.grains = "disc";
  support.stiffness = 0.5;
  support.damping = 0.3;
  support.x = {AxisCondition::Mode::displacement, {{0, 1, 3}, {0, 0.2, -0.1}}};
  support.part = {.kind = OutlinePart::Kind::side, .side = {0, -1}};
  scene.boundary = {support};
  expect_second_order_of(scene);
}

}  // namespace
}  // namespace pliant::dynamics_tests
