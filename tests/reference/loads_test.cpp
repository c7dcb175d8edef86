// Everything that acts on bodies from outside, and the energy balance of its work: against the engine, and in closed
// form.
#include "reference/loads.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/both.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::reference_tests {
namespace {

using namespace dynamics_tests;
using reference::EnergyBalance;
using reference::SolverOptions;
using reference::Vector;
using Kind = BoundaryCondition::Kind;
using Mode = AxisCondition::Mode;

/// What came out at the end of a scene.
struct Outcome {
  Vector q;         ///< [dofs]
  Vector energies;  ///< kinetic, strain, boundary, dissipated, external work, J/m
};

Outcome loaded_by_engine(Scene scene, double safety) {
  without_error_control(scene, safety);
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, scene.time.end);
  const Energies e = simulation.energy_balance().energy;
  return {engine_positions(simulation),
          (Vector(5) << e.kinetic, e.strain, e.boundary, e.dissipated, e.external_work).finished()};
}

Outcome loaded_by_reference(const Scene& scene, int steps, const SolverOptions& options = {}) {
  ReferenceRun run(scene, options);
  run.run(steps);
  const EnergyBalance& b = run.stepping.balance();
  return {run.stepping.motion().q,
          (Vector(5) << b.kinetic, b.strain, b.boundary, b.dissipated(), b.external_work()).finished()};
}

/// INDEPENDENT: both are of second order. Halving a step takes three quarters of an error away, so that a third of what
/// it changed is left; as much again is allowed, because the engine's steps are halved but for what it takes to meet
/// points of histories.
void expect_agreement(const Scene& scene, int steps, double safety, double most_left = 2e-3) {
  const Outcome engine = loaded_by_engine(scene, safety), finer_engine = loaded_by_engine(scene, safety / 2);
  const Outcome reference = loaded_by_reference(scene, steps), finer = loaded_by_reference(scene, 2 * steps);
  const auto compare = [=](const Vector& a, const Vector& coarse_a, const Vector& b, const Vector& coarse_b,
                           double size) {
    const double left = (a - coarse_a).cwiseAbs().maxCoeff() + (b - coarse_b).cwiseAbs().maxCoeff();
    EXPECT_LT(left, most_left * size) << "steps too long to tell anything";
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 2 * left / 3 + 1e-12 * size);
  };
  compare(finer_engine.q, engine.q, finer.q, reference.q, 1);
  const double whole = finer.energies.cwiseAbs().maxCoeff();
  for (int i = 0; i < 5; ++i) {
    SCOPED_TRACE("energy " + std::to_string(i));
    compare(finer_engine.energies.segment<1>(i), engine.energies.segment<1>(i), finer.energies.segment<1>(i),
            reference.energies.segment<1>(i), whole);
  }
}

History ramp(double first, double last, double until) { return {{0, until}, {first, last}}; }

AxisCondition drive(Mode mode, const History& history, double damping = 0) { return {mode, history, damping, {}}; }

BoundaryCondition pressure_on(int number, const History& history, bool following, const OutlinePart& part) {
  BoundaryCondition condition;
  condition.kind = Kind::pressure;
  condition.grains = "discs";
  condition.number = number;
  condition.pressure = history;
  condition.following = following;
  condition.part = part;
  return condition;
}

BoundaryCondition support_of(const std::string& grains, double stiffness, double damping, const AxisCondition& x,
                             const AxisCondition& y) {
  BoundaryCondition condition;
  condition.kind = Kind::support;
  condition.grains = grains;
  condition.stiffness = stiffness;
  condition.damping = damping;
  condition.x = x, condition.y = y;
  return condition;
}

/// Turned discs of another size that touch nothing.
Scene discs(int count, double end) {
  Scene scene = empty_scene(end);
  scene.shapes = {disc_shape("disc", 2, 30)};
  Points centres;
  for (int i = 0; i < count; ++i) centres.emplace_back(5.0 * i, 0.5 * i);
  scene.grains = {grains("discs", "disc", BodyKind::compliant, centres, moving({0.1, -0.05}, 0.2))};
  scene.grains[0].size.factors = {0.9};
  scene.grains[0].velocity.gradient << 0.1, 0.2, 0, -0.1;
  scene.grains[0].angle = 0.4;
  return scene;
}

TEST(ReferenceLoads, pressures_act_as_in_the_engine) {
  Scene scene = discs(3, 1);
  const OutlinePart arc{.kind = OutlinePart::Kind::angles, .first = -0.7, .second = 1.2};
  const OutlinePart below{.kind = OutlinePart::Kind::box, .low = {9, 0}, .high = {11, 0.9}};
  scene.boundary = {pressure_on(0, ramp(0.1, 0.4, 1), true, arc),
                    pressure_on(1, ramp(0.3, 0.1, 0.6), false, {.kind = OutlinePart::Kind::side, .side = {-1, 0}}),
                    pressure_on(2, ramp(0.2, 0.3, 2), false, below)};
  scene.boundary[2].direction = Vec2(0.6, 0.8);
  expect_agreement(scene, 50, 0.1);
}

TEST(ReferenceLoads, supports_act_as_in_the_engine) {
  Scene scene = discs(2, 1);
  scene.boundary = {support_of("discs", 1.5, 0.4, drive(Mode::velocity, ramp(0.1, 0.4, 1)),
                               drive(Mode::displacement, ramp(0, 0.2, 2))),
                    support_of("discs", 0.7, 0.2, AxisCondition::none(), AxisCondition{})};
  scene.boundary[0].part = {.kind = OutlinePart::Kind::side, .side = {0, 1}};
  scene.boundary[1].part = {.kind = OutlinePart::Kind::side, .side = {1, 0}};
  scene.boundary[1].number = 1;
  expect_agreement(scene, 50, 0.1);
}

/// On the outline of a grain of cells, and not on the edges between these.
TEST(ReferenceLoads, act_on_breakable_grains_as_in_the_engine) {
  Scene scene = discs(1, 1);
  scene.shapes = {disc_shape("disc", 2, 80)};
  scene.grains[0].cells.assign(3, 1);
  scene.grains[0].velocity.gradient.setZero();
  BondRule bonds;
  bonds.first = bonds.second = "all";
  bonds.stiffness = 10, bonds.strength = 10, bonds.fracture_energy = 10;
  scene.bonds = {bonds};
  scene.boundary = {pressure_on(0, ramp(0.1, 0.4, 1), true, {}),
                    support_of("discs", 1.5, 0.4, drive(Mode::velocity, ramp(0.1, 0.4, 1)), AxisCondition::none())};
  scene.boundary[0].number.reset();
  scene.boundary[1].part = {.kind = OutlinePart::Kind::side, .side = {0, 1}};
  expect_agreement(scene, 160, 0.1);
}

/// All that sets in and ends during the run, one of the supports as stiff as contacts are by themselves.
TEST(ReferenceLoads, windows_open_and_close_as_in_the_engine) {
  Scene scene = discs(2, 1);
  const AxisCondition along = drive(Mode::velocity, ramp(0.1, 0.4, 1));
  scene.boundary = {support_of("discs", 1.5, 0.4, along, AxisCondition{}),
                    support_of("discs", 1, 0, AxisCondition::none(), along), pressure_on(1, constant(0.2), true, {}),
                    BoundaryCondition{}};
  scene.boundary[1].stiffness.reset();
  scene.boundary[1].part = {.kind = OutlinePart::Kind::side, .side = {-1, 0}};
  scene.boundary[0].window = {0.3, 0.7}, scene.boundary[1].window = {0.2, 1e9}, scene.boundary[2].window = {-1, 0.5};
  scene.shapes.push_back(box_shape("box", 2, 1, 0.5));
  scene.grains.push_back(grains("box", "box", BodyKind::rigid, {{20, 0}}));
  scene.boundary[3].grains = "box";
  scene.boundary[3].x = {Mode::force, ramp(0.5, 1, 1), 0.1, {0.25, 0.75}};
  scene.boundary[3].y = {Mode::velocity, ramp(0.1, 0.3, 1), 0, {0, 0.55}};
  expect_agreement(scene, 100, 0.05);
  const ReferenceRun run(scene, {});
  EXPECT_EQ(run.system.loads().switch_times(), (std::vector<double>{0.2, 0.25, 0.3, 0.5, 0.55, 0.7, 0.75, 1, 1e9}))
      << "EXACT: and the point of the histories";
}

/// EXACT: momenta are the areas of the histories, cut off by their windows, however long the steps that are asked for
/// are; points within rounding of each other do no harm. The square's pressure does not follow.
TEST(ReferenceLoads, impulses_shorter_than_a_step_are_those_of_their_histories) {
  const double close = std::nextafter(0.7, 1);
  const History pulse{{0.1, 0.11, 0.12, 0.7, close, 0.8}, {0, 1, 0, 0, 3, 0}};
  constexpr double area = 0.01 + 0.15, until_0_11 = 0.005;
  Scene scene = empty_scene(1);
  scene.shapes = {box_shape("box", 2, 1, 0.5)};
  scene.grains = {grains("hard", "box", BodyKind::rigid, {{0, 0}}),
                  grains("soft", "box", BodyKind::compliant, {{0, 10}})};
  BoundaryCondition pushed;
  pushed.grains = "hard";
  pushed.x = drive(Mode::force, pulse);
  pushed.y = drive(Mode::force, pulse);
  pushed.y.window.until = 0.11;
  BoundaryCondition pressed = pressure_on(0, pulse, false, {.kind = OutlinePart::Kind::side, .side = {-1, 0}});
  pressed.grains = "soft";
  scene.boundary = {pushed, pressed};
  scene.gravity_history = {{{0.3, 0.301}, {0, 0}}, pulse};
  ReferenceRun run(scene, {});
  run.run(4);
  const Vector p = run.stepping.mass() * run.stepping.motion().v;
  EXPECT_NEAR(p[0], area, 1e-12);
  EXPECT_NEAR(p[1], until_0_11 + 2 * area, 1e-12) << "mass 2";
  double x = 0, y = 0;
  for (int i = 3; i < p.size(); i += 2) x += p[i], y += p[i + 1];
  EXPECT_NEAR(x, area, 1e-12);
  EXPECT_NEAR(y, 2 * area, 1e-12);
}

TEST(ReferenceLoads, viscosity_and_mass_damping_act_as_in_the_engine) {
  Scene scene = free_disc(30, 1, stretching(0.4));
  scene.materials[0].viscosity = 0.1;
  scene.materials[0].mass_damping = 0.3;
  scene.gravity_history = {ramp(0.1, 0.5, 1), ramp(-0.2, 0.3, 0.5)};
  expect_agreement(scene, 50, 0.1);
}

/// Rigid boxes under all drives, and walls under forces, servo pressure and dashpots, beside a compliant disc.
TEST(ReferenceLoads, drives_and_walls_act_as_in_the_engine) {
  Scene scene = discs(1, 1);
  scene.period = 40;
  scene.gravity = {0.1, -0.3};
  scene.materials[1].mass_damping = 0.2;
  scene.shapes.push_back(box_shape("box", 2, 1, 0.5));
  for (const char* name : {"pushed", "led", "held"})
    scene.grains.push_back(
        grains(name, "box", BodyKind::rigid, {{5.0 * double(scene.grains.size()), 0}}, moving({0.2, 0.1}, 0.3)));
  BoundaryCondition condition;
  condition.grains = "pushed";
  condition.x = drive(Mode::force, ramp(0.2, 0.6, 1), 0.5);
  condition.angle = drive(Mode::force, ramp(0.1, -0.2, 1), 0.1);
  scene.boundary.push_back(condition);
  condition.grains = "led";
  condition.x = drive(Mode::velocity, ramp(0.2, -0.3, 1));
  condition.y = AxisCondition::none();
  condition.angle = drive(Mode::velocity, ramp(0.3, 0.5, 1));
  scene.boundary.push_back(condition);
  condition.grains = "held";
  condition.x = condition.angle = AxisCondition{};
  scene.boundary.push_back(condition);
  scene.walls = {flat_wall("lower", Wall::Solid::below, -5, 0.5), flat_wall("upper", Wall::Solid::above, 5, 0.5)};
  scene.walls[0].x = drive(Mode::force, ramp(3, 5, 1), 2);
  scene.walls[0].y = drive(Mode::pressure, ramp(0.2, 0.1, 1), 0.3);
  scene.walls[1].x = drive(Mode::velocity, ramp(0, 0.2, 1));
  scene.walls[1].y = drive(Mode::pressure, ramp(0.1, 0.4, 1), 0.3);
  expect_agreement(scene, 50, 0.1);
  for (Wall& wall : scene.walls) wall.y = drive(Mode::force, ramp(-2, 3, 1), 0.4);
  expect_agreement(scene, 50, 0.1);
}

/// EXACT: where all targets go at one speed V, they work V times the impulse that they give, which is the disc's
/// momentum.
TEST(ReferenceLoads, targets_that_move_their_dashpots_work) {
  constexpr double speed = 0.3;
  Scene scene = free_disc(30, 4);
  const AxisCondition along = drive(Mode::velocity, constant(speed));
  scene.boundary = {support_of("disc", 0.05, 0.2, along, AxisCondition::none())};
  double momentum = 0, missing[2] = {};
  for (const int halved : {0, 1}) {
    ReferenceRun run(scene, {});
    run.run(20 << halved);
    const EnergyBalance& balance = run.stepping.balance();
    const Vector p = run.stepping.mass() * run.stepping.motion().v;
    momentum = 0;
    for (int i = 0; i < p.size(); i += 2) momentum += p[i];
    EXPECT_NEAR(balance.work_of_loads, speed * momentum, 1e-9 * speed * momentum) << "EXACT: Newton's tolerance";
    missing[halved] = std::abs(balance.made());
  }
  EXPECT_GT(momentum, 0.5) << "most of the disc's mass x speed has come about";
  // RATE: the mean of the ends' forces errs by the third power of the step's stretch: at least second order.
  EXPECT_GT(observed_order({2, 1}, {missing[0], missing[1]}), 1.8);
}

/// EXACT: at rest contacts bear a servo wall's pressure, whatever the wall weighs; the floor bears the block besides.
TEST(ReferenceLoads, contacts_bear_a_walls_pressure_under_gravity) {
  constexpr double pressure = 0.02, gravity = 0.02, period = 3;
  Scene scene = on_a_floor(1, period, 0.25, {0, -gravity});
  scene.shapes = {box_shape("block", 2, 2, 0.5)};
  scene.grains = {grains("block", "block", BodyKind::compliant, {{1.5, 0.999}})};
  scene.walls.push_back(flat_wall("lid", Wall::Solid::above, 1.998, 0.25, 0.5));
  scene.walls[1].y = drive(Mode::pressure, constant(pressure), 3);
  SolverOptions statics;
  statics.statics = true;
  ReferenceRun run(scene, statics);
  run.run(1);
  std::size_t nodes = 0;
  for (const reference::Body& body : run.system.bodies().all()) nodes += body.outline.size();
  const Points forces = forces_on_nodes(run.stepping.forces().contacts, nodes);
  const auto on = [&](const std::string& name) {
    double force = 0;
    for (const reference::Body& body : run.system.bodies().all())
      for (std::size_t i = 0; body.placed.name == name && i < body.outline.size(); ++i)
        force += forces[static_cast<std::size_t>(body.first_outline) + i].y();
    return force;
  };
  // Newton's residual is 1e-9 of the forces, times the roots of their numbers.
  EXPECT_NEAR(on("lid"), pressure * period, 1e-7 * pressure * period);
  EXPECT_NEAR(on("floor"), -(pressure * period + 4 * gravity), 1e-7 * pressure * period);
}

/// EXACT: everything imposed leaves no equation; positions are integrals of histories, and the work is the kinetic
/// energy.
TEST(ReferenceLoads, scenes_without_free_bodies_move_as_told) {
  Scene scene = empty_scene(2);
  scene.shapes = {box_shape("box", 2, 1, 0.5)};
  scene.grains = {grains("box", "box", BodyKind::rigid, {{1, 2}})};
  BoundaryCondition condition;
  condition.grains = "box";
  condition.x = drive(Mode::velocity, ramp(0, 3, 2));
  condition.y = drive(Mode::velocity, constant(-0.5));
  condition.angle = drive(Mode::velocity, ramp(1, 0, 2));
  scene.boundary = {condition};
  ReferenceRun run(scene, {});
  const Vector& q = run.run(7);
  EXPECT_NEAR(q[0], 1 + 3, 1e-12);
  EXPECT_NEAR(q[1], 2 - 1, 1e-12);
  EXPECT_NEAR(q[2], 1, 1e-12);
  const double inertia = 2 * (4 + 1) / 12.0;
  EXPECT_NEAR(run.stepping.balance().kinetic, 0.5 * 2 * (9 + 0.25), 1e-12);
  EXPECT_NEAR(run.stepping.balance().work_of_loads, 0.5 * 2 * 9 - 0.5 * inertia, 1e-12);
  EXPECT_LT(run.stepping.balance().balance_error(), 1e-14);
  SolverOptions statics;
  statics.statics = true;
  EXPECT_NEAR(run_reference(scene, 3, statics)[0], 1 + 3, 1e-12) << "EXACT: the same";
}

}  // namespace
}  // namespace pliant::reference_tests
