// Drives of rigid grains, drives that set in and end, and walls pressed through a dashpot (docs/method.md 5).
#include <gtest/gtest.h>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

Scene rigid_disc(double end, const BoundaryCondition& condition) {
  Scene scene = empty_scene(end);
  scene.shapes = {polygonal_disc("disc", 2, 40)};
  scene.grains = {grains("disc", "disc", BodyKind::rigid, {{0, 0}, {5, 100}})};
  scene.boundary = {condition};
  return scene;
}

BoundaryCondition drives_of(const std::string& grains, int number) {
  BoundaryCondition condition;
  condition.grains = grains;
  condition.number = number;
  return condition;
}

TEST(RigidGrain, obeys_one_drive_an_axis_and_its_fellow_none) {
  BoundaryCondition condition = drives_of("disc", 1);
  condition.x = {AxisCondition::Mode::velocity, {{0, 2}, {0, 1}}};
  condition.y = {AxisCondition::Mode::force, constant(0.3)};
  condition.angle = {AxisCondition::Mode::force, constant(-0.2)};
  for (const Integrator integrator : {Integrator::verlet, Integrator::step_doubling}) {
    Scene scene = rigid_disc(2, condition);
    scene.time.integrator = integrator;
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 2);
    const RigidBody& body = model.rigid_bodies[1];
    const Eigen::Vector3d x = rigid(simulation.state().position, 1), v = rigid(simulation.state().reduced_momentum, 1);
    const double turn = -0.2 / body.dof[2].mass, push = 0.3 / body.dof[1].mass;
    EXPECT_NEAR(x[0], 6, 1e-13) << "EXACT";
    EXPECT_NEAR(v[0], 1, 1e-13) << "EXACT";
    EXPECT_NEAR(v[1], 2 * push, 1e-13) << "EXACT";
    EXPECT_NEAR(v[2], 2 * turn, 1e-13) << "EXACT";
    EXPECT_EQ(rigid(simulation.state().position, 0), Eigen::Vector3d(0, 0, 0)) << "EXACT";
    const double kinetic =
        0.5 * (body.dof[0].mass + body.dof[1].mass * 4 * push * push + body.dof[2].mass * 4 * turn * turn);
    EXPECT_NEAR(simulation.energy_balance().energy.kinetic, kinetic, 1e-12) << "EXACT";
    if (integrator == Integrator::verlet) {
      EXPECT_LT(simulation.balance_error(simulation.energy_balance().energy), 1e-12) << "EXACT: constant forces";
    }
  }
}

TEST(RigidGrain, that_is_fixed_stays_whatever_speed_it_was_given) {
  BoundaryCondition condition = drives_of("disc", 0);
  condition.x.mode = condition.y.mode = condition.angle.mode = AxisCondition::Mode::fixed;
  Scene scene = rigid_disc(1, condition);
  scene.grains[0].velocity = moving({1, 2}, 3);
  const Model model = build_model(scene);
  Simulation simulation(model);
  EXPECT_EQ(rigid(simulation.state().reduced_momentum, 0), Eigen::Vector3d(0, 0, 0)) << "EXACT";
  advance(simulation, 1);
  EXPECT_EQ(rigid(simulation.state().position, 0), Eigen::Vector3d(0, 0, 0)) << "EXACT";
  EXPECT_EQ(rigid(simulation.state().reduced_momentum, 1), Eigen::Vector3d(1, 2, 3)) << "EXACT: the other one";
}

/// Pushed from 0.5 to 1.25, carried at speed 2 from rest or flight until 1: free before and after.
TEST(Window, holds_a_drive_from_its_start_to_its_end) {
  BoundaryCondition condition = drives_of("disc", 0);
  condition.x = {AxisCondition::Mode::velocity, constant(2)};
  condition.x.window.until = 1;
  condition.y = {AxisCondition::Mode::force, constant(0.4)};
  condition.y.window = {0.5, 1.25};
  condition.angle = {AxisCondition::Mode::velocity, constant(1)};
  condition.angle.window.from = 1;
  for (const Integrator integrator : {Integrator::verlet, Integrator::step_doubling}) {
    Scene scene = rigid_disc(2, condition);
    scene.gravity = {-0.5, 0};
    scene.time.integrator = integrator;
    const Model model = build_model(scene);
    Simulation simulation(model);
    double longest = 0;
    while (simulation.state().time < 2) longest = std::max(longest, simulation.step(2).dt);
    if (integrator == Integrator::verlet) longest = 0;
    const Eigen::Vector3d x = rigid(simulation.state().position, 0), v = rigid(simulation.state().reduced_momentum, 0);
    const double push = 0.4 / model.rigid_bodies[0].dof[1].mass;
    EXPECT_NEAR(v[0], 2 - 0.5, 1e-12) << "EXACT: let go with the speed it had, then gravity";
    EXPECT_NEAR(x[0], 2 + 2 - 0.25, 0.5 * longest / 4 + 1e-12) << "EXACT; RATE: Euler steps lag by a t dt/4";
    EXPECT_NEAR(v[1], 0.75 * push, 1e-12) << "EXACT";
    EXPECT_NEAR(x[2], 1, 1e-12) << "EXACT";
    EXPECT_EQ(v[2], 1) << "EXACT";
  }
}

TEST(Window, of_a_wall_lets_it_go) {
  Scene scene = on_a_floor(2, 4, 0.25, {0, 0});
  scene.shapes = {disc_shape("disc", 2, 20)};
  scene.grains = {grains("far", "disc", BodyKind::rigid, {{2, 50}})};
  scene.walls[0].y = {AxisCondition::Mode::velocity, constant(0.5)};
  scene.walls[0].y.window.until = 1;
  scene.gravity = {0, -0.3};
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 2);
  EXPECT_NEAR(rigid(simulation.state().reduced_momentum, 1)[1], 0.5 - 0.3, 1e-12) << "EXACT: free after 1";
  EXPECT_LT(simulation.balance_error(simulation.energy_balance().energy), 1e-11) << "EXACT: constant forces";
}

/// m v' = L (p - d v): a servo wall in free flight approaches the speed p/d, whatever it weighs.
void expect_servo_flight(Integrator integrator, const Vec2& gravity, const std::vector<History>& gravity_history) {
  constexpr double pressure = 0.7, damping = 2, end = 1.5;
  Scene scene = on_a_floor(end, 3, 0.25, {0, 0});
  scene.shapes = {disc_shape("disc", 2, 20)};
  scene.grains = {grains("far", "disc", BodyKind::rigid, {{2, 50}})};
  scene.boundary = {drives_of("far", 0)};
  for (AxisCondition* drive : {&scene.boundary[0].x, &scene.boundary[0].y, &scene.boundary[0].angle})
    *drive = AxisCondition{};
  scene.walls[0].y = {AxisCondition::Mode::pressure, constant(pressure)};
  scene.walls[0].y.damping = damping;
  scene.gravity = gravity;
  scene.gravity_history = gravity_history;
  scene.time.integrator = integrator;
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, end);
  const double rate = damping * 3 / model.rigid_bodies[1].dof[1].mass;
  const double exact = pressure / damping * (1 - std::exp(-rate * end));
  EXPECT_NEAR(rigid(simulation.state().reduced_momentum, 1)[1], exact, 1e-12) << "EXACT: at default settings";
  EXPECT_LT(simulation.balance_error(simulation.energy_balance().energy), 1e-11) << "EXACT";
}

TEST(ServoWall, approaches_the_speed_of_pressure_over_damping) {
  expect_servo_flight(Integrator::verlet, {0, 0}, {});
  expect_servo_flight(Integrator::verlet, {0.4, -0.9}, {});
}

TEST(ServoWall, does_not_feel_a_gravity_that_changes) {
  expect_servo_flight(Integrator::verlet, {0, 0}, {{{0, 1}, {0, 0.2}}, {{0, 0.5, 1}, {0, -2, 1}}});
}

/// Gravity is borne as long as the pressure acts, 1, and not after: 0.7 x 3 over the mass, then free fall.
TEST(ServoWall, falls_when_its_pressure_ends) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::step_doubling}) {
    Scene scene = on_a_floor(2, 3, 0.25, {0, -0.3});
    scene.shapes = {disc_shape("disc", 2, 20)};
    scene.grains = {grains("far", "disc", BodyKind::rigid, {{2, 50}})};
    scene.walls[0].y = {AxisCondition::Mode::pressure, constant(0.7)};
    scene.walls[0].y.window.until = 1;
    scene.time.integrator = integrator;
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 2);
    const double push = 0.7 * 3 / model.rigid_bodies[1].dof[1].mass;
    EXPECT_NEAR(rigid(simulation.state().reduced_momentum, 1)[1], push - 0.3, 1e-12) << "EXACT";
    if (integrator == Integrator::verlet) {
      EXPECT_LT(simulation.balance_error(simulation.energy_balance().energy), 1e-11) << "EXACT: constant forces";
    }
  }
}

struct Pressed {
  double largest = 0, last = 0;  ///< force on the floor over pressure x period
  double lid = 0;                ///< force on the lid at the end, N/m
  double imbalance = 0;
};

/// A lid pressed on a compliant block that lies on the floor.
Pressed pressed_block(double damping, double gravity = 0) {
  constexpr double pressure = 0.02, end = 60;
  Scene scene = on_a_floor(end, 3, 0.25, {0, -gravity});
  scene.shapes = {box_shape("block", 2, 2, 0.4)};
  scene.grains = {grains("block", "block", BodyKind::compliant, {{1.5, 1.0}})};
  scene.materials[0].viscosity = 0.1;
  scene.walls.push_back(flat_wall("lid", Wall::Solid::above, 2.0, 0.25, 0.5));
  scene.walls[1].y = {AxisCondition::Mode::pressure, constant(pressure)};
  scene.walls[1].y.damping = damping;
  const Model model = build_model(scene);
  Simulation simulation(model);
  Pressed result;
  while (simulation.state().time < end) {
    simulation.step(end);
    result.last = -contact_force(simulation, 1).y() / (pressure * 3);
    result.largest = std::max(result.largest, result.last);
  }
  result.lid = contact_force(simulation, 2).y();
  result.imbalance = simulation.balance_error(simulation.energy_balance().energy);
  return result;
}

TEST(ServoWall, reaches_its_pressure_without_ringing_when_damped_enough) {
  const Pressed ringing = pressed_block(0), servo = pressed_block(3);
  EXPECT_GT(ringing.largest, 1.5) << "EXACT: a load that is there at once doubles, but for the block's own viscosity";
  EXPECT_LT(servo.largest, 1.01) << "EXACT: above critical damping nothing overshoots but the block itself";
  EXPECT_NEAR(servo.last, 1, 1e-3) << "EXACT: equilibrium";
  EXPECT_LT(servo.imbalance, 0.01) << "EXACT: the promise of 1 %";
}

/// A lid whose weight is half its load lies on the block with the pressure alone; the floor bears the block's weight
/// besides, 4 g.
TEST(ServoWall, is_held_against_its_own_weight) {
  constexpr double gravity = 0.02, load = 0.02 * 3;
  const Pressed servo = pressed_block(3, gravity);
  EXPECT_NEAR(servo.lid, load, 1e-3 * load) << "EXACT: equilibrium, as without gravity";
  EXPECT_NEAR(servo.last * load, load + 4 * gravity, 1e-3 * load) << "EXACT: the same";
  EXPECT_LT(servo.imbalance, 0.01) << "EXACT: the promise of 1 %";
}

}  // namespace
}  // namespace pliant::dynamics_tests
