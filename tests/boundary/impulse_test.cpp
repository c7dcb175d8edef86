// Loads shorter than a step: impulses are those of the histories and windows, to rounding, with both integrators
// (docs/method.md 5).
#include <gtest/gtest.h>

#include <cmath>

#include "boundary/outline_loads.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr Integrator both[] = {Integrator::verlet, Integrator::step_doubling};
constexpr double rounding = 1e-12;  ///< of some thousand steps

/// Both signs, shorter than any step: 0.01 of area, from 1.01 to 1.03, and 0.003 until 1.05.
const History pulse{{0, 1.01, 1.02, 1.03, 1.04, 1.05}, {0, 0, 1, 0, 0.6, 0}};
constexpr double pulse_area = 0.01 + 0.006;

/// Two boxes, 2 x 1, of rigid and of compliant material, nothing to touch.
Scene two_boxes(Integrator integrator, double end) {
  Scene scene = empty_scene(end);
  scene.shapes = {box_shape("box", 2, 1, 0.25)};
  scene.grains = {grains("hard", "box", BodyKind::rigid, {{0, 0}}),
                  grains("soft", "box", BodyKind::compliant, {{0, 10}})};
  scene.time.integrator = integrator;
  return scene;
}

BoundaryCondition pressure_on_a_side(const std::string& grains, const History& pressure, bool following) {
  BoundaryCondition condition;
  condition.kind = BoundaryCondition::Kind::pressure;
  condition.grains = grains;
  condition.pressure = pressure;
  condition.following = following;
  condition.part = {.kind = OutlinePart::Kind::side, .side = {-1, 0}};
  return condition;
}

/// Momentum of each kind of box over its mass.
struct Speeds {
  Eigen::Vector3d hard;
  Vec2 soft;
};

Speeds speeds(const Simulation& simulation) {
  const Model& model = simulation.model();
  return {rigid(simulation.state().reduced_momentum, 0),
          mass_mean(model, model.bodies[1], simulation.state().reduced_momentum)};
}

Speeds speeds_at_end(const Scene& scene) {
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, scene.time.end);
  return speeds(simulation);
}

TEST(Impulse, of_pulses_by_force_and_moment) {
  for (const Integrator integrator : both) {
    Scene scene = two_boxes(integrator, 3);
    BoundaryCondition drive;
    drive.grains = "hard";
    drive.x = {AxisCondition::Mode::force, pulse};
    drive.y = {AxisCondition::Mode::force, constant(0.3), 0, {1.01, 1.013}};
    drive.angle = {AxisCondition::Mode::force, pulse, 0, {1.02, 1.04}};
    scene.boundary = {drive};
    const double mass = 2, inertia = 2 * (4 + 1) / 12.0;
    const Speeds end = speeds_at_end(scene);
    EXPECT_NEAR(end.hard[0], pulse_area / mass, rounding) << "EXACT";
    EXPECT_NEAR(end.hard[1], 0.3 * 0.003 / mass, rounding) << "EXACT: from and until";
    EXPECT_NEAR(end.hard[2], (0.005 + 0.003) / inertia, rounding) << "EXACT: a history cut off by its window";
  }
}

TEST(Impulse, of_pulses_by_pressures) {
  for (const Integrator integrator : both) {
    Scene scene = two_boxes(integrator, 3);
    scene.boundary = {pressure_on_a_side("hard", pulse, true), pressure_on_a_side("hard", constant(0.2), true),
                      pressure_on_a_side("hard", pulse, false), pressure_on_a_side("soft", pulse, false),
                      pressure_on_a_side("soft", constant(0.2), false)};
    scene.boundary[1].window = scene.boundary[4].window = {0.517, 0.5181};
    const double window = 0.2 * 0.0011, mass = 2;
    const Speeds end = speeds_at_end(scene);
    EXPECT_NEAR(end.hard[0], (2 * pulse_area + window) / mass, rounding) << "EXACT: following and oriented";
    EXPECT_NEAR(end.hard[2], 0, rounding) << "EXACT: through the centre";
    EXPECT_NEAR(end.soft.x(), (pulse_area + window) / mass, rounding) << "EXACT: oriented";
  }
}

/// EXACT: on the geometry at hand, which is the outline's at either end of each step, whatever it has been deformed to.
TEST(Impulse, of_a_following_pressure_on_a_deforming_outline) {
  Scene scene = two_boxes(Integrator::verlet, 3);
  scene.boundary = {pressure_on_a_side("soft", {{0, 0.3, 0.31, 1}, {0, 0.8, 0.1, 0.4}}, true),
                    pressure_on_a_side("soft", constant(0.5), true)};
  scene.boundary[1].window = {0.2, 0.7};
  const Model model = build_model(scene);
  Simulation simulation(model);
  const auto load = [&](bool ends_step) {
    const State& state = simulation.state();
    return outline_load(model, 1, state.outlines, {state.time, ends_step});
  };
  Vec2 impulse(0, 0);
  while (simulation.state().time < 3) {
    const Vec2 before = load(false);
    const double dt = simulation.step(3).dt;
    impulse += 0.5 * dt * (before + load(true));
  }
  EXPECT_GT(impulse.x(), 1);
  EXPECT_NEAR((2 * speeds(simulation).soft - impulse).norm(), 0, rounding);
}

TEST(Impulse, of_gravity_with_a_history) {
  for (const Integrator integrator : both) {
    Scene scene = two_boxes(integrator, 3);
    scene.gravity_history = {pulse, {{1, 1.001, 1.002}, {0, -500, 0}}};
    const Speeds end = speeds_at_end(scene);
    const Vec2 gained(pulse_area, -0.5);
    EXPECT_LT((end.hard.head<2>() - gained).norm(), rounding) << "EXACT";
    EXPECT_LT((end.soft - gained).norm(), 10 * rounding) << "EXACT: of forces of 500 a unit mass";
  }
}

Scene servo_wall(Integrator integrator, double damping) {
  Scene scene = on_a_floor(3, 3, 0.25, {0, 0});
  scene.shapes = {box_shape("box", 2, 1, 0.25)};
  scene.grains = {grains("far", "box", BodyKind::rigid, {{1.5, 50}})};
  scene.walls[0].y = {AxisCondition::Mode::pressure, pulse, damping, {-1, 1.025}};
  scene.time.integrator = integrator;
  return scene;
}

/// What the pressure gives goes into the wall's momentum and into its dashpot, damping times the way.
TEST(Impulse, of_a_servo_wall) {
  constexpr double until_1_025 = 0.005 + 0.00375, period = 3, mass = 3;
  for (const Integrator integrator : both) {
    const Model model = build_model(servo_wall(integrator, 0));
    Simulation simulation(model);
    advance(simulation, 3);
    EXPECT_NEAR(rigid(simulation.state().reduced_momentum, 1)[1], until_1_025 * period / mass, rounding) << "EXACT";
  }
  const Model model = build_model(servo_wall(Integrator::verlet, 4));
  Simulation simulation(model);
  while (simulation.state().time < 1.025) simulation.step(3);
  const double v = rigid(simulation.state().reduced_momentum, 1)[1], y = rigid(simulation.state().position, 1)[1];
  EXPECT_GT(y, 1e-5);
  EXPECT_NEAR(mass * v + 4 * period * y, until_1_025 * period, rounding) << "EXACT";
  EXPECT_EQ(simulation.state().time, 1.025);
  EXPECT_EQ(simulation.state().force.rigid[4], 0) << "EXACT: load and dashpot are gone";
  advance(simulation, 3);
  EXPECT_EQ(rigid(simulation.state().reduced_momentum, 1)[1], v) << "EXACT: it flies on";
}

/// The dashpots of a support of which only the far end moves, by leaps shorter than a step, on a body that hardly
/// gives: damping x length x way.
TEST(Impulse, of_a_support_whose_target_leaps) {
  Scene scene = two_boxes(Integrator::verlet, 3);
  BoundaryCondition support;
  support.kind = BoundaryCondition::Kind::support;
  support.grains = "soft";
  support.stiffness = 0;
  support.damping = 1e-9;
  support.x = {AxisCondition::Mode::displacement, {{1, 1.001, 2, 2.0001}, {0, 3, 3, 1}}};
  scene.boundary = {support};
  EXPECT_NEAR(speeds_at_end(scene).soft.x() * 2 / (1e-9 * 6 * 1), 1, 1e-9 * 6 * 3 * 3 / 2)
      << "EXACT: length 6, way 1; the body goes along by damping x length x way / mass x time, way and time 3 at most";
}

/// EXACT: a load that ends leaves no work unbooked, and what still acts at the time of its end has done half of
/// nothing.
TEST(Impulse, of_windows_closes_the_balance) {
  Scene scene = two_boxes(Integrator::verlet, 2);
  BoundaryCondition drive;
  drive.grains = "hard";
  drive.x = {AxisCondition::Mode::force, constant(0.4), 0, {0.3, 0.9}};
  drive.y = {AxisCondition::Mode::force, constant(0.7), 0.6, {0.2, 1.7}};
  scene.boundary = {drive, pressure_on_a_side("hard", constant(0.2), false)};
  scene.boundary[1].window = {0.517, 0.7};
  const Model model = build_model(scene);
  Simulation simulation(model);
  while (simulation.state().time < 2) {
    simulation.step(2);
    if (simulation.state().time > 0.25)
      EXPECT_LT(simulation.balance_error(simulation.energy_balance().energy), rounding)
          << "at " << simulation.state().time;
  }
  EXPECT_GT(simulation.state().dissipated, 0.01);
}

int steps_with(const History& gravity, Integrator integrator) {
  Scene scene = two_boxes(integrator, 4);
  scene.grains[1].velocity = stretching(0.05);
  scene.gravity_history = {gravity, constant(0)};
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 4);
  EXPECT_NEAR(rigid(simulation.state().reduced_momentum, 0)[0], gravity.integral(0, 4), 1e-11) << "EXACT";
  return static_cast<int>(simulation.state().steps);
}

/// EXACT: each point costs at most the step that it cuts and, with equal steps on both sides, one more.
TEST(Steps, cut_short_do_not_slow_the_run_down) {
  const double close = std::nextafter(2, 3), closer = std::nextafter(close, 3);
  const History resting{{0, 4}, {0, 0}}, points{{0, 0.9, 1, 2, close, 3, 3 + 1e-13, 4}, {0, 0, 0, 0, 0, 0, 0, 0}},
      pulses{{0, 0.9, 0.9 + 1e-7, 0.9 + 2e-7, 2, close, closer, 3, 3 + 1e-9, 3 + 2e-9, 4},
             {0, 0, 1e3, 0, 0, 1, 0, 0, 10, 0, 0}};
  for (const Integrator integrator : both) {
    const int plain = steps_with(resting, integrator);
    EXPECT_LE(steps_with(points, integrator), plain + 2 * 7);
    EXPECT_LE(steps_with(pulses, integrator), plain + 2 * 10) << "a leap of the acceleration is not in any step";
  }
}

/// EXACT: a measured record has thousands of points; a step ends at each, and few more are taken.
TEST(Steps, meet_each_point_of_a_record) {
  History record;
  for (int i = 0; i <= 3000; ++i) {
    record.time.push_back(i * 1e-3);
    record.value.push_back(std::sin(7.0 * i) + std::cos(0.01 * i * i));
  }
  for (const Integrator integrator : both) {
    const int steps = steps_with(record, integrator);
    EXPECT_GE(steps, 3000);
    EXPECT_LE(steps, 3200);
  }
}

}  // namespace
}  // namespace pliant::dynamics_tests
