// A run that starts from where another one ended (docs/results.md, "Starting from another run").
#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <utility>

#include "core/archive.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double dt = 1.0 / 512;  ///< of two: times and their differences are exact
constexpr int before = 300, after = 200;

void step_evenly(Simulation& simulation, int steps) {
  for (int i = 1; i <= steps; ++i) {
    const double until = simulation.state().time + dt;
    while (simulation.state().time < until) simulation.step(until);
  }
}

/// By way of the bytes that a file holds.
StartPoint point_of(const Simulation& simulation) {
  StartPoint point = simulation.start_point(), read;
  std::string bytes;
  SaveLeaf save(bytes);
  Walk{save}("start", point);
  LoadLeaf load(bytes);
  Walk{load}("start", read);
  EXPECT_TRUE(load.empty());
  return read;
}

/// Grains of both kinds that rub under a lid; nothing acts at a time of its own.
Scene rubbing(ContactRule rule) {
  Scene scene = small_third_body(1000);
  scene.walls[1].x.history = constant(0.1);
  scene.walls[1].y.history = constant(0.1);
  scene.gravity = {0, -0.01};
  scene.contacts = {std::move(rule)};
  scene.contact.energy_consistent = false;
  return scene;
}

Scene with_friction() { return rubbing(mohr_coulomb(100, 0.4)); }
Scene with_bonds() {
  Scene scene = rubbing(mohr_coulomb(100, 0.4));
  BondRule rule;
  rule.first = rule.second = "all";
  rule.gap = 0.02;
  rule.strength = 0.5, rule.fracture_energy = 0.075;
  rule.fatigue_rate = rule.shear_fatigue_rate = 0.5;
  rule.fatigue_threshold = 1e-3;
  scene.bonds = {rule};
  return scene;
}
Scene torn_bonds() {
  Scene scene = bursting_disc(1000);
  scene.contact.energy_consistent = false;
  return scene;
}
Scene with_a_branch() {
  Scene scene = with_friction();
  Material& soft = scene.materials[0];
  soft.law = MaterialLaw::neo_hookean_maxwell, soft.branch_modulus = 1, soft.relaxation_time = 0.5;
  scene.discretisation.mass = Mass::corrected;
  return scene;
}

struct StartCase {
  const char* name;
  std::function<Scene()> scene;
  Integrator integrator;
};

/// What ctest lists beside the test's name.
void PrintTo(const StartCase& one, std::ostream* out) { *out << one.name; }

class AStart : public ::testing::TestWithParam<StartCase> {};

/// Equal steps from exact times: what is left is the rounding of forces that are computed anew, 1e-15 of the largest,
/// 1, over masses of 1e-2, which grows no faster than the square of 200 steps of 2e-3 in positions.
TEST_P(AStart, goes_on_as_the_run_did) {
  constexpr double rounding = 1e-11;
  Scene scene = GetParam().scene();
  scene.time.integrator = GetParam().integrator;
  scene.time.target = 1;
  const Model model = build_model(scene);
  Simulation whole(model);
  step_evenly(whole, before);
  StartPoint start = point_of(whole);
  Simulation next(model, &start);
  EXPECT_EQ(next.state().time, 0);
  EXPECT_EQ(next.state().external_work, 0);
  EXPECT_EQ(next.state().dissipated, 0);
  EXPECT_EQ(next.overlap().pairs, 0) << "contact at the start is no overlap of a packing";
  EXPECT_NEAR(next.energy_balance().energy.mechanical(), whole.energy_balance().energy.mechanical(), 1e-13) << "EXACT";
  start.contact.contact_pairs = {}, start.contact.history = {};
  for (auto& ends : start.bonds.history.ends)
    for (BondEnd& end : ends) end.damage = broadcast(1);
  Simulation forgetful(model, &start);
  step_evenly(whole, after), step_evenly(next, after), step_evenly(forgetful, after);
  EXPECT_EQ(whole.state().time, (before + after) * dt);
  EXPECT_EQ(next.state().time, after * dt);
  EXPECT_LT(largest_difference(next.state().position, whole.state().position), rounding) << "EXACT";
  EXPECT_LT(largest_difference(next.state().reduced_momentum, whole.state().reduced_momentum), 1e3 * rounding)
      << "EXACT";
  EXPECT_GT(largest_difference(forgetful.state().position, whole.state().position), 1e5 * rounding)
      << "slips and damage count";
}

INSTANTIATE_TEST_SUITE_P(All, AStart,
                         ::testing::Values(StartCase{"friction", with_friction, Integrator::verlet},
                                           StartCase{"bonds", with_bonds, Integrator::verlet},
                                           StartCase{"torn_bonds", torn_bonds, Integrator::verlet},
                                           StartCase{"branch", with_a_branch, Integrator::verlet},
                                           StartCase{"doubling", with_friction, Integrator::step_doubling}),
                         [](const auto& info) { return info.param.name; });

/// A block at rest on a slope, held by friction.
Scene on_a_slope(double friction, double damping) {
  Scene scene = on_a_floor(1000, 20, 0.1, {0.2, -1});
  scene.shapes = {box_shape("block", 2, 0.5, 0.1)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{10, 0.249}})};
  scene.contacts = {mohr_coulomb(100, friction)};
  scene.materials[1].mass_damping = damping;
  return scene;
}

/// It slides as its new friction has it, at g_x - f g_y.
TEST(StartPoint, takes_the_new_scenes_friction_and_drives) {
  const Model held = build_model(on_a_slope(0.5, 4));
  Simulation first(held);
  advance(first, 20);
  EXPECT_LT(rigid(first.state().reduced_momentum, 0).norm(), 1e-9) << "it rests";
  const StartPoint start = point_of(first);
  const Model let_go = build_model(on_a_slope(0.1, 0));
  Simulation second(let_go, &start);
  EXPECT_LT(second.energy_balance().energy.kinetic, 1e-18);
  advance(second, 1);
  // Of the weight 1 m; what the block rocks by as its shear gets less, 0.1 m of 100 Pa/m on 2 m, is 1e-3 of a second.
  EXPECT_NEAR(rigid(second.state().reduced_momentum, 0)[0], 0.2 - 0.1, 1e-3) << "EXACT";
  EXPECT_LT(second.balance_error(second.energy_balance().energy), 0.01) << "EXACT: energy balance from here on";
  Scene driven = on_a_slope(0.5, 0);
  driven.walls[0].x = {AxisCondition::Mode::velocity, constant(0.3)};
  const Model moving_floor = build_model(driven);
  Simulation third(moving_floor, &start);
  EXPECT_EQ(rigid(third.state().reduced_momentum, 1)[0], 0.3) << "EXACT: imposed from the start on";
  advance(third, 0.5);
  EXPECT_NEAR(rigid(third.state().position, 1)[0] - rigid(first.state().position, 1)[0], 0.15, 1e-14) << "EXACT";
}

/// EXACT: a body in touch with itself starts with another law of itself; at no state it would be refused.
TEST(StartPoint, a_body_pressed_on_itself_takes_another_law) {
  Scene scene = empty_scene(4);
  ShapeSpec clamp = box_shape("clamp", 2, 2, 0.13);
  clamp.points = {{-1, -1}, {1, -1}, {1, -0.15}, {-0.4, -0.15}, {-0.4, 0.15}, {1, 0.15}, {1, 1}, {-1, 1}};
  scene.shapes = {clamp};
  InitialVelocity closing;
  closing.gradient << 0, 0, 0, -0.35;
  scene.grains = {grains("clamp", "clamp", BodyKind::compliant, {{0, 0}}, closing)};
  scene.contacts = {frictionless(300)};
  scene.contact.self_contact = true;
  const Model model = build_model(scene);
  Simulation first(model);
  while (first.state().time < 4 && first.energy_balance().energy.contact < 1e-4) first.step(4);
  ASSERT_GE(first.energy_balance().energy.contact, 1e-4) << "it touches itself";
  const StartPoint start = point_of(first);
  scene.contacts = {mohr_coulomb(300, 0.4)};
  const Model other = build_model(scene);
  EXPECT_NO_THROW(Simulation(other, &start));
}

TEST(StartPoint, of_other_bodies_is_refused) {
  const Model one = build_model(on_a_slope(0.5, 0)), other = build_model(with_friction());
  const StartPoint start = Simulation(one).start_point();
  EXPECT_THROW(Simulation(other, &start), ArchiveError) << "EXACT";
  StartPoint damaged = start;
  damaged.contact.laws.kinds.push_back(0);
  EXPECT_THROW(Simulation(one, &damaged), ArchiveError) << "EXACT";
}

}  // namespace
}  // namespace pliant::dynamics_tests
