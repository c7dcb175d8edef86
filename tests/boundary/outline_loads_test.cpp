// Pressures and soft supports on parts of outlines (docs/method.md 5): forces, work, energy balance.
#include "boundary/outline_loads.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "bodies/nodal.hpp"
#include "bodies/place_outlines.hpp"
#include "core/errors.hpp"
#include "setup/build_model.hpp"
#include "support/bench.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

using Kind = BoundaryCondition::Kind;

BoundaryCondition pressure_on(const std::string& grains, double pressure, bool following) {
  BoundaryCondition condition;
  condition.kind = Kind::pressure;
  condition.grains = grains;
  condition.pressure = constant(pressure);
  condition.following = following;
  return condition;
}

OutlinePart side(const Vec2& outward) { return {.kind = OutlinePart::Kind::side, .side = outward}; }

double largest_force(const Bench& bench) {
  double result = 0;
  for (const Lanes& f : bench.state.force.compliant) result = std::max(result, std::abs(f[0]));
  return result;
}

/// Nominal stress of a disc stretched by a in all directions, neo-Hookean: mu (a - 1/a) + 2 lambda ln(a)/a.
double nominal_stress(double a) { return (a - 1 / a) + 4 * 2 * std::log(a) / a; }

/// A disc of another size is in equilibrium everywhere, inside and at its nodes (docs/method.md 2, condition 2), with
/// the pressure -P on its first outline, or -P/a on its present one.
TEST(Pressure, holds_a_shrunken_disc_in_equilibrium) {
  for (const bool following : {true, false}) {
    constexpr double a = 0.8;
    const double pressure = -nominal_stress(a) / (following ? a : 1);
    Scene scene = free_disc(60, 1);
    Bench unloaded(scene);
    unloaded.deform(a * Eigen::Matrix2d::Identity());
    EXPECT_GT(largest_force(unloaded), 0.1);
    scene.boundary = {pressure_on("disc", pressure, following)};
    Bench bench(scene);
    bench.deform(a * Eigen::Matrix2d::Identity());
    EXPECT_LT(largest_force(bench), 1e-12) << "EXACT: patch test, following " << following;
  }
}

Vec2 total_force(const Bench& bench) {
  Vec2 total(0, 0);
  for (std::size_t i = 0; i < bench.state.force.compliant.size(); i += 2)
    total += Vec2(bench.state.force.compliant[i][0], bench.state.force.compliant[i + 1][0]);
  return total;
}

/// A square of side 2 about (0.5, -0.25).
Scene square(const BoundaryCondition& condition) {
  Scene scene = empty_scene(1);
  scene.shapes = {box_shape("square", 2, 2, 0.4)};
  scene.grains = {grains("square", "square", BodyKind::compliant, {{0.5, -0.25}})};
  scene.boundary = {condition};
  return scene;
}

TEST(Pressure, on_a_part_sums_to_pressure_times_its_length) {
  BoundaryCondition top = pressure_on("square", 0.3, false);
  top.part = side({0, 1});
  EXPECT_LT((total_force(Bench(square(top))) - Vec2(0, -0.6)).norm(), 1e-13) << "EXACT";
  top.part = {.kind = OutlinePart::Kind::angles, .first = std::numbers::pi / 4, .second = 3 * std::numbers::pi / 4};
  EXPECT_LT((total_force(Bench(square(top))) - Vec2(0, -0.6)).norm(), 1e-13) << "EXACT: seen from the centre";
  top.part = {.kind = OutlinePart::Kind::angles, .first = -std::numbers::pi / 4, .second = std::numbers::pi / 4};
  EXPECT_LT((total_force(Bench(square(top))) - Vec2(-0.6, 0)).norm(), 1e-13) << "EXACT: across the direction 0";
  top.part = {.kind = OutlinePart::Kind::box, .low = {-1, 0.5}, .high = {2, 1}};
  top.direction = Vec2(0.6, 0.8);
  EXPECT_LT((total_force(Bench(square(top))) - 0.3 * (2 + 2 * 0.25) * Vec2(0.6, 0.8)).norm(), 0.3 * 0.4)
      << "EXACT: to half a segment at either end";
  EXPECT_GT(total_force(Bench(square(top))).norm(), 0.6);
}

/// Loads without pressure of a square that consists of cells: sum, and sum of the norms, m.
std::pair<Vec2, double> loads_of_cells(const OutlinePart& part) {
  BoundaryCondition condition = pressure_on("square", 1, false);
  condition.part = part;
  Scene scene = square(condition);
  scene.shapes = {box_shape("square", 2, 2, 0.1)};
  scene.grains[0].cells.assign(6, 1);
  const Model model = build_model(scene);
  EXPECT_EQ(model.bodies.size(), 6u);
  Vec2 sum(0, 0);
  double length = 0;
  for (const OutlinePressure& pressure : model.pressures)
    for (const Vec2& load : pressure.dead_load) sum += load, length += load.norm();
  return {sum, length};
}

/// EXACT: conditions on a breakable grain concern its outline, not the edges between its cells. Four corners with half
/// a segment on both sides count by the diagonal.
TEST(Pressure, acts_on_the_outline_of_a_breakable_grain) {
  const auto [top, of_top] = loads_of_cells(side({0, 1}));
  EXPECT_LT((top - Vec2(0, -2)).norm(), 1e-13);
  EXPECT_NEAR(of_top, 2, 1e-13);
  const auto [all, of_all] = loads_of_cells({});
  EXPECT_LT(all.norm(), 1e-13);
  EXPECT_NEAR(of_all, 8 - 4 * 0.1 * (1 - std::numbers::sqrt2 / 2), 1e-13);
  const auto [right, of_right] = loads_of_cells(
      {.kind = OutlinePart::Kind::angles, .first = -std::numbers::pi / 4, .second = std::numbers::pi / 4});
  EXPECT_LT((right - Vec2(-2, 0)).norm(), 1e-13) << "seen from the centre of the grain";
  EXPECT_NEAR(of_right, 2, 1e-13);
  try {
    loads_of_cells({.kind = OutlinePart::Kind::box, .low = {0.4, -0.3}, .high = {0.6, -0.2}});
    FAIL() << "edges between cells are no part of the outline";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("of 'square' lies"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("centre (0.5, -0.25)"), std::string::npos) << error.what();
  }
}

/// A following pressure turns and grows with its part, one that does not stays what it was.
TEST(Pressure, follows_the_present_outline_or_the_first) {
  BoundaryCondition top = pressure_on("square", 0.3, false);
  top.part = side({0, 1});
  const Eigen::Matrix2d F = matrix(1.2, 0, 0.5, 0.9);  // the top goes from (-1, 1) to (1, 1): its vector is F (2, 0)
  for (const bool following : {true, false}) {
    top.following = following;
    Bench bench(square(top));
    bench.deform(F);
    const Vec2 along = following ? Vec2(F * Vec2(2, 0)) : Vec2(2, 0);
    EXPECT_LT((total_force(bench) - 0.3 * Vec2(along.y(), -along.x())).norm(), 1e-13)
        << "EXACT: internal forces sum to nothing";
  }
}

TEST(Pressure, on_rigid_grains_gives_force_and_moment) {
  BoundaryCondition right = pressure_on("square", 0.3, false);
  right.part = {.kind = OutlinePart::Kind::box, .low = {1.45, -0.25}, .high = {2, 1}};  // upper half of the right side
  Scene scene = square(right);
  scene.grains[0].species = {{BodyKind::rigid, "hard", 1}};
  scene.shapes[0].spacing = 0.25;
  const Bench bench(scene);
  EXPECT_NEAR(bench.state.force.rigid[0], -0.3, 1e-13) << "EXACT: length 1";
  EXPECT_NEAR(bench.state.force.rigid[2], 0.15, 1e-13) << "EXACT: at half a unit above the centre";
}

TEST(Pressure, on_no_segment_is_refused) {
  BoundaryCondition nowhere = pressure_on("square", 0.3, false);
  nowhere.part = {.kind = OutlinePart::Kind::box, .low = {5, 5}, .high = {6, 6}};
  EXPECT_THROW(build_model(square(nowhere)), InputError);
}

TEST(Pressure, leaves_the_outlines_with_contact_forces_alone) {
  Scene scene = free_disc(60, 1);
  scene.boundary = {pressure_on("disc", 1, true)};
  const Bench bench(scene);
  for (double f : bench.state.contact_force.x) EXPECT_EQ(f, 0) << "EXACT";
}

double area(const Model& model, const Dofs& position) {
  const Points outline = outline_values(model, model.bodies[0], position);
  double twice = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 &a = outline[k], &b = outline[(k + 1) % outline.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

/// The polygon's area is quadratic in its nodes, so the trapezoidal rule of a constant pressure is exact.
TEST(Work, of_a_following_pressure_is_the_loss_of_area) {
  Scene scene = free_disc(60, 1, stretching(0.3));
  scene.boundary = {pressure_on("disc", 0.4, true)};
  const Model model = build_model(scene);
  Simulation simulation(model);
  const double start = area(model, simulation.state().position);
  advance(simulation, 1);
  const double work = 0.4 * (start - area(model, simulation.state().position));
  EXPECT_GT(work, 0.01);
  EXPECT_NEAR(simulation.state().external_work, work, 1e-13) << "EXACT";
  EXPECT_LT(simulation.balance_error(simulation.energy_balance().energy), 1e-3) << "RATE: second order in the step";
}

TEST(Work, of_a_pressure_on_a_rigid_grain_is_its_kinetic_energy) {
  for (const bool following : {true, false}) {
    BoundaryCondition right = pressure_on("square", 0.3, following);
    right.pressure = {{0, 1}, {0.1, 0.5}};
    right.part = {.kind = OutlinePart::Kind::box, .low = {1.45, -0.25}, .high = {2, 1}};
    Scene scene = square(right);
    scene.grains[0].species = {{BodyKind::rigid, "hard", 1}};
    scene.time.end = 4;
    scene.time.tolerance = 1e-4;
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 4);
    const Energies energy = simulation.energy_balance().energy;
    EXPECT_GT(energy.kinetic, 0.1);
    EXPECT_NEAR(energy.external_work / energy.kinetic, 1, 1e-3) << "RATE: trapezoidal rule, following " << following;
  }
}

BoundaryCondition support_of(const std::string& grains, double stiffness, double damping) {
  BoundaryCondition condition;
  condition.kind = Kind::support;
  condition.grains = grains;
  condition.stiffness = stiffness;
  condition.damping = damping;
  condition.x.mode = condition.y.mode = AxisCondition::Mode::fixed;
  return condition;
}

TEST(Support, pulls_back_by_stiffness_times_length_along_the_axes_that_it_holds) {
  BoundaryCondition bottom = support_of("square", 5, 0);
  bottom.part = side({0, -1});
  bottom.x = {AxisCondition::Mode::displacement, constant(0.3)};
  Bench bench(square(bottom));
  EXPECT_LT((total_force(bench) - Vec2(5 * 2 * 0.3, 0)).norm(), 1e-13) << "EXACT";
  EXPECT_NEAR(support_energy(bench.model, bench.state.outlines.position, {0}), 0.5 * 5 * 2 * 0.09, 1e-13) << "EXACT";
  bottom.x.mode = AxisCondition::Mode::free;
  bottom.y = {AxisCondition::Mode::velocity, constant(0.2)};
  Bench later(square(bottom));
  later.state.time = 2;
  later.evaluate_here();
  EXPECT_LT((total_force(later) - Vec2(0, 5 * 2 * 0.4)).norm(), 1e-13) << "EXACT";
}

TEST(Support, without_a_stiffness_takes_that_of_contacts) {
  BoundaryCondition all = support_of("square", 0, 0);
  all.stiffness.reset();
  const Model model = build_model(square(all));
  EXPECT_NEAR(model.supports[0].stiffness, 8 * 2.8 / 0.4, 1e-9) << "EXACT: 8 E/h";
}

/// A square on springs all around swings as one mass on one spring, slowly against its own modes.
TEST(Support, lets_a_body_swing_at_the_frequency_of_spring_and_mass) {
  constexpr double stiffness = 1e-4, length = 8, mass = 4;
  Scene scene = square(support_of("square", stiffness, 0));
  scene.grains[0].velocity.uniform = {1e-3, 0};
  const double quarter = std::numbers::pi / 2 / std::sqrt(stiffness * length / mass);
  scene.time.end = 1.2 * quarter;
  const Model model = build_model(scene);
  Simulation simulation(model);
  double before = 1, time = 0;
  while (simulation.state().time < 1.2 * quarter && before > 0) {
    simulation.step(1.2 * quarter);
    const double speed = mass_mean(model, model.bodies[0], simulation.state().reduced_momentum).x();
    if (speed <= 0) time = simulation.state().time;
    before = speed;
  }
  EXPECT_NEAR(time / quarter, 1, 2e-3) << "EXACT: to the step and (w/w_body)^2";
}

/// Dragged through its dashpots, let go, caught again: all energies are accounted for.
TEST(Support, books_close_when_it_moves_damps_sets_in_and_ends) {
  BoundaryCondition bottom = support_of("square", 5, 0.5);
  bottom.part = side({0, -1});
  bottom.x = {AxisCondition::Mode::velocity, {{0, 1, 2}, {0, 0.3, 0.3}}};
  bottom.window.until = 3;
  BoundaryCondition top = support_of("square", 2, 0.2);
  top.part = side({0, 1});
  top.y.mode = AxisCondition::Mode::free;
  top.window.from = 4;
  const auto imbalance = [&](double safety) {
    Scene scene = square(bottom);
    scene.boundary.push_back(top);
    scene.time.end = 6;
    without_error_control(scene, safety);
    const Model model = build_model(scene);
    EXPECT_EQ(model.switch_times, (std::vector<double>{1, 2, 3, 4})) << "EXACT";
    Simulation simulation(model);
    double worst = 0;
    bool met = false;
    while (simulation.state().time < 6) {
      simulation.step(6);
      met |= simulation.state().time == 3;
      const Energies e = simulation.energy_balance().energy;
      worst = std::max(worst, std::abs(e.mechanical() - e.external_work + e.dissipated));
    }
    EXPECT_TRUE(met) << "EXACT: a step ends where the support does";
    const Energies end = simulation.energy_balance().energy;
    EXPECT_GT(end.dissipated, 0.01);
    EXPECT_GT(end.external_work, 0.1);
    return worst;
  };
  const double coarse = imbalance(0.4), middle = imbalance(0.2), fine = imbalance(0.1);
  EXPECT_NEAR(observed_order(coarse, fine, 4), 2, 0.3) << "RATE: velocity Verlet, dashpots with it";
  EXPECT_NEAR(observed_order(middle, fine), 2, 0.5) << "RATE";
}

/// A pulled square is let go at one side while the other holds on: what the energy balance lose over the step of the
/// release, over the energy in the springs that end. RATE: the cube of the step, as in any other; with the energy of
/// the springs alone it is the first order.
TEST(Support, that_ends_while_another_holds_leaves_the_books_closed) {
  const auto loss = [](double safety) {
    BoundaryCondition bottom = support_of("square", 5, 0), top = bottom;
    bottom.part = side({0, -1});
    top.part = side({0, 1});
    top.y = {AxisCondition::Mode::displacement, {{0, 2}, {0, 0.4}}};
    top.window.until = 2;
    Scene scene = square(bottom);
    scene.boundary.push_back(top);
    scene.time.end = 4;
    without_error_control(scene, safety);
    const Model model = build_model(scene);
    Simulation simulation(model);
    const auto imbalance = [&] {
      const Energies e = simulation.energy_balance().energy;
      return e.mechanical() - e.external_work + e.dissipated;
    };
    double before = 0, stored = 0;
    while (simulation.state().time < 2) {
      before = imbalance();
      stored = simulation.energy_balance().energy.boundary;
      simulation.step(4);
    }
    return std::abs(imbalance() - before) / stored;
  };
  const double coarse = loss(0.8), middle = loss(0.2), fine = loss(0.05);
  EXPECT_NEAR(observed_order(middle, fine, 4), 3, 0.3);
  EXPECT_LT(coarse, 0.05) << "0.16 with the energy of the springs alone";
}

/// The bound counts the springs: at safety 1 the motion stays bounded, well above it grows.
TEST(Support, enters_the_stability_bound) {
  const auto energy_after = [](double safety) {
    Scene scene = square(support_of("square", 1e4, 0.5));
    scene.grains[0].velocity.uniform = {1e-6, 1e-6};
    without_error_control(scene, safety);
    const Model model = build_model(scene);
    Simulation simulation(model);
    try {
      for (int i = 0; i < 400; ++i) simulation.step(1e9);
    } catch (const PhysicsError&) {
      return std::numeric_limits<double>::infinity();  // turned inside out
    }
    return simulation.energy_balance().energy.mechanical();
  };
  EXPECT_LT(energy_after(1), 1e-11) << "EXACT: stable";
  EXPECT_GT(energy_after(2), 1) << "EXACT: the bound gives away less than a factor of two";
}

}  // namespace
}  // namespace pliant::dynamics_tests
