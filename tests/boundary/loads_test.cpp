// What moves bodies from outside: imposed histories, forces and pressures, gravity, and the work that they do
// (docs/method.md 5).
#include "boundary/loads.hpp"

#include <gtest/gtest.h>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

/// A wall by itself; one small rigid disc far away, because a scene has grains.
Scene lone_wall(double end, Wall::Solid solid, double thickness = 0.5) {
  Scene scene = empty_scene(end);
  scene.period = 3;
  scene.shapes = {disc_shape("disc", 1, 20)};
  scene.grains = {grains("far", "disc", BodyKind::rigid, {{1, solid == Wall::Solid::below ? 50.0 : -50.0}})};
  scene.walls = {flat_wall("wall", solid, 0, 0.3, thickness)};
  return scene;
}

constexpr int wall_index = 1;  ///< behind the grain

TEST(ImposedMotion, follows_the_integral_of_its_history) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::step_doubling}) {
    Scene scene = lone_wall(4, Wall::Solid::above);
    const History history{{0.5, 1, 1.7, 3}, {0, 0.4, -1, 0.3}};
    scene.walls[0].x = {AxisCondition::Mode::velocity, history};
    scene.walls[0].y = {AxisCondition::Mode::velocity, constant(-0.25)};
    scene.time.integrator = integrator;
    const Model model = build_model(scene);
    Simulation simulation(model);
    while (simulation.state().time < 4) {
      simulation.step(4);
      const double t = simulation.state().time;
      const Eigen::Vector3d x = rigid(simulation.state().position, wall_index),
                            v = rigid(simulation.state().reduced_momentum, wall_index);
      EXPECT_NEAR(x[0], history.integral(0, t), 1e-13) << "EXACT: rounding of some hundred steps";
      EXPECT_NEAR(x[1], -0.25 * t, 1e-13) << "EXACT";
      EXPECT_NEAR(v[0], history.at(t), 1e-12) << "EXACT";
      EXPECT_EQ(x[2], 0) << "EXACT: walls do not turn";
    }
    EXPECT_NEAR(rigid(simulation.state().position, wall_index)[0], 0.1 + -0.21 - 0.455 + 0.3, 1e-13)
        << "EXACT: by hand";
  }
}

/// Mass of the wall: density 1, period 3, thickness 0.5. A pressure pushes towards the grains, away from the solid.
TEST(Pressure, accelerates_a_wall_by_pressure_times_period_over_mass) {
  for (const Wall::Solid solid : {Wall::Solid::below, Wall::Solid::above}) {
    Scene scene = lone_wall(2, solid);
    scene.walls[0].y = {AxisCondition::Mode::pressure, constant(0.7)};
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 2);
    const double acceleration = (solid == Wall::Solid::below ? 1 : -1) * 0.7 * 3 / 1.5;
    EXPECT_NEAR(rigid(simulation.state().position, wall_index)[1], 0.5 * acceleration * 4, 1e-12)
        << "EXACT: Verlet, constant force";
    EXPECT_NEAR(rigid(simulation.state().reduced_momentum, wall_index)[1], acceleration * 2, 1e-12) << "EXACT";
    EXPECT_EQ(rigid(simulation.state().position, wall_index)[0], 0) << "EXACT: x is fixed";
  }
}

TEST(Force, accelerates_a_wall_and_gives_it_the_impulse_of_a_ramp) {
  Scene scene = lone_wall(2, Wall::Solid::below);
  scene.walls[0].x = {AxisCondition::Mode::force, {{0, 2}, {0, 3}}};
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 2);
  EXPECT_NEAR(rigid(simulation.state().reduced_momentum, wall_index)[0], 3 / 1.5, 1e-12)
      << "EXACT: the trapezoidal rule of a linear force";
}

/// Free flight under gravity: every node of both kinds of body follows the parabola.
Scene falling(Integrator integrator) {
  Scene scene = empty_scene(3);
  scene.gravity = {0.2, -1};
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("soft", "disc", BodyKind::compliant, {{0, 0}}, moving({0.5, 0.7})),
                  grains("hard", "disc", BodyKind::rigid, {{10, 0}}, moving({0.5, 0.7}, 1.5))};
  scene.time.integrator = integrator;
  return scene;
}

Vec2 parabola(double t) { return Vec2(0.5, 0.7) * t + 0.5 * t * t * Vec2(0.2, -1); }

TEST(Gravity, free_fall_is_exact_in_verlet) {
  const Model model = build_model(falling(Integrator::verlet));
  const Body& soft = model.bodies[0];
  Simulation simulation(model);
  const State start = simulation.state();
  while (simulation.state().time < 3) {
    simulation.step(3);
    const State& state = simulation.state();
    const Vec2 moved = parabola(state.time);
    for (int i = 0; i < model.shape_of(model.batches[0]).nodes(); ++i)
      EXPECT_LT(
          (node_value(model, soft, state.position, i) - node_value(model, soft, start.position, i) - moved).norm(),
          1e-11)
          << "EXACT";
    EXPECT_LT((rigid(state.position, 0).head<2>() - Vec2(10, 0) - moved).norm(), 1e-12) << "EXACT";
    EXPECT_NEAR(rigid(state.position, 0)[2], 1.5 * state.time, 1e-12) << "EXACT: it spins on";
  }
}

/// Two Euler steps of dt/2 lag behind by a dt^2/4 a step, so by at most a t dt/4 in all.
TEST(Gravity, free_fall_in_step_doubling_is_off_by_its_first_order) {
  const Model model = build_model(falling(Integrator::step_doubling));
  Simulation simulation(model);
  double largest_dt = 0;
  while (simulation.state().time < 3) largest_dt = std::max(largest_dt, simulation.step(3).dt);
  const double error = (rigid(simulation.state().position, 0).head<2>() - Vec2(10, 0) - parabola(3)).norm();
  EXPECT_GT(error, 0);
  EXPECT_LE(error, Vec2(0.2, -1).norm() * 3 * largest_dt / 4 * (1 + 1e-9)) << "RATE";
}

TEST(Work, of_gravity_is_the_kinetic_energy_gained) {
  const Model model = build_model(falling(Integrator::verlet));
  Simulation simulation(model);
  const double start = simulation.energy_balance().energy.kinetic;
  advance(simulation, 3);
  const Energies energy = simulation.energy_balance().energy;
  double mass = 0;
  for (const Body& body : model.bodies) mass += body.mass;
  const double work = mass * parabola(3).dot(Vec2(0.2, -1));
  EXPECT_NEAR(energy.external_work, work, 1e-11 * work) << "EXACT";
  EXPECT_NEAR(energy.kinetic - start, work, 1e-11 * work) << "EXACT";
  EXPECT_LT(simulation.balance_error(energy), 1e-11) << "EXACT";
}

/// EXACT: velocities get the integral of a linear history by the trapezoidal rule; both kinds of body. RATE: the work,
/// as positions do not: at most dt^2 / 8 times the mass and all changes of g^2, 0.16 of x and 2 of y.
TEST(Gravity, may_have_a_history) {
  Scene scene = falling(Integrator::verlet);
  scene.gravity_history = {{{0, 2}, {0, 0.4}}, {{0, 2}, {-1, 1}}};
  scene.gravity = scene.gravity_at(0);
  EXPECT_EQ(scene.gravity_at(0.5), Vec2(0.1, -0.5));
  scene.time.end = 2;
  const Model model = build_model(scene);
  Simulation simulation(model);
  double dt = 0;
  while (simulation.state().time < 2) dt = std::max(dt, simulation.step(2).dt);
  const Vec2 gained(0.4, 0), start(0.5, 0.7);
  EXPECT_LT((mass_mean(model, model.bodies[0], simulation.state().reduced_momentum) - start - gained).norm(), 1e-11);
  EXPECT_LT((rigid(simulation.state().reduced_momentum, 0).head<2>() - start - gained).norm(), 1e-11);
  const Energies energy = simulation.energy_balance().energy;
  double mass = 0;
  for (const Body& body : model.bodies) mass += body.mass;
  EXPECT_NEAR(energy.external_work, 0.5 * mass * ((start + gained).squaredNorm() - start.squaredNorm()),
              dt * dt / 8 * mass * 2.16);
  EXPECT_LT(simulation.balance_error(energy), 1e-3);
}

/// EXACT: lanes without a body stay where they are, however long bodies beside them fall.
TEST(Gravity, leaves_padding_lanes_alone) {
  const Model model = build_model(falling(Integrator::verlet));
  ASSERT_LT(model.batches[0].count, lane_count);
  Simulation simulation(model);
  const Dofs start = simulation.state().position;
  advance(simulation, 3);
  for (std::size_t i = 0; i < start.compliant.size(); ++i)
    for (int lane = model.batches[0].count; lane < lane_count; ++lane)
      ASSERT_NEAR(simulation.state().position.compliant[i][lane], start.compliant[i][lane], 1e-12)
          << "rounding of internal forces at rest";
}

/// EXACT: the whole force until the load's end, none behind it, wherever the steps end; a step's work too much or too
/// little, 2 a dt / v, where state.time + dt misses the end by a rounding.
TEST(Work, of_a_load_that_ends_is_the_kinetic_energy) {
  for (int i = 1; i <= 40; ++i) {
    const double end = 0.1 + 0.037 * i;
    Scene scene = lone_wall(2, Wall::Solid::below);
    scene.walls[0].x = {AxisCondition::Mode::force, constant(3)};
    scene.walls[0].x.window.until = end;
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 2);
    const Energies energy = simulation.energy_balance().energy;
    EXPECT_NEAR(rigid(simulation.state().reduced_momentum, wall_index)[0], 3 / 1.5 * end, 1e-12) << end;
    EXPECT_NEAR(energy.external_work / energy.kinetic, 1, 1e-11) << end;
  }
}

TEST(Work, of_a_pressure_is_the_kinetic_energy_of_the_wall) {
  Scene scene = lone_wall(2, Wall::Solid::above);
  scene.walls[0].x = {AxisCondition::Mode::force, {{0, 2}, {1, -2}}};
  scene.walls[0].y = {AxisCondition::Mode::pressure, constant(0.7)};
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 2);
  const Energies energy = simulation.energy_balance().energy;
  const double pressed = std::pow(0.7 * 3 * 2, 2) / (2 * 1.5),
               pushed = std::pow(2 - 3, 2) / (2 * 1.5);  // impulse^2 / (2 mass)
  EXPECT_NEAR(energy.external_work, pressed + pushed, 2e-3) << "RATE: trapezoidal rule";
  EXPECT_LT(simulation.balance_error(energy), 2e-3) << "RATE: trapezoidal rule of a force that changes";
}

TEST(Work, of_an_imposed_acceleration_is_the_kinetic_energy_of_the_wall) {
  Scene scene = lone_wall(2, Wall::Solid::above);
  scene.walls[0].x = {AxisCondition::Mode::velocity, {{0, 1}, {0, 2}}};
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 2);
  const Energies energy = simulation.energy_balance().energy;
  EXPECT_NEAR(energy.kinetic, 0.5 * 1.5 * 4, 1e-12) << "EXACT";
  EXPECT_NEAR(energy.external_work, energy.kinetic, 1e-12) << "EXACT";
}

/// A plate moved at constant speed does minus the contact force on it times its way; here summed from the contact
/// forces of each step.
TEST(Work, of_an_imposed_motion_is_that_of_the_contact_forces_against_it) {
  Scene scene = lone_wall(3, Wall::Solid::above);
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("disc", "disc", BodyKind::compliant, {{1.5, 1.01}})};
  scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 0.25), flat_wall("plate", Wall::Solid::above, 2.03, 0.25)};
  scene.walls[1].y = {AxisCondition::Mode::velocity, constant(-0.05)};
  scene.gravity = {0, -0.02};
  const Model model = build_model(scene);
  Simulation simulation(model);
  double work = 0;
  while (simulation.state().time < 3) {
    const double before = contact_force(simulation, 2).y();
    const StepReport report = simulation.step(3);
    work += 0.5 * (before + contact_force(simulation, 2).y()) * 0.05 * report.dt;
  }
  // The plate's own weight is moved as well: gravity's work on it, minus what the drive does against it, is nothing.
  const double weight_work = -0.02 * model.bodies[2].mass * -0.15;
  EXPECT_GT(work, 1e-4);
  EXPECT_NEAR(simulation.state().external_work, work - weight_work, 1e-10) << "EXACT";
  const double balance = simulation.balance_error(simulation.energy_balance().energy);
  EXPECT_LT(balance, 0.01) << "EXACT: the promise of 1 %";
}

/// The largest imbalance met while a plate sets itself in motion, touches a disc and squeezes it.
double largest_imbalance(double safety) {
  Scene scene = lone_wall(3, Wall::Solid::above);
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("disc", "disc", BodyKind::compliant, {{1.5, 1.01}})};
  scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 0.25), flat_wall("plate", Wall::Solid::above, 2.03, 0.25)};
  scene.walls[1].y = {AxisCondition::Mode::velocity, {{0, 1}, {0, -0.05}}};
  without_error_control(scene, safety);
  const Model model = build_model(scene);
  Simulation simulation(model);
  double largest = 0;
  while (simulation.state().time < 3) {
    simulation.step(3);
    const Energies energy = simulation.energy_balance().energy;
    largest = std::max(largest, std::abs(energy.mechanical() - energy.external_work));
  }
  return largest;
}

TEST(Work, books_close_as_the_square_of_the_step) {
  const double coarse = largest_imbalance(0.8), middle = largest_imbalance(0.2), fine = largest_imbalance(0.05);
  EXPECT_LT(middle, coarse);
  EXPECT_LT(fine, middle);
  EXPECT_NEAR(observed_order(coarse, fine, 16), 2, 0.5) << "RATE";
}

}  // namespace
}  // namespace pliant::dynamics_tests
