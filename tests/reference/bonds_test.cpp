// Bonds of the reference solver (docs/method.md 11).
#include "reference/bonds/bonds.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.hpp"
#include "reference/outputs/view.hpp"
#include "reference/tangent_error.hpp"
#include "reference/time_stepping.hpp"
#include "support/figures.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

namespace pliant::reference_tests {
namespace {

using namespace testing;
using reference::Forces;
using reference::Motion;
using reference::System;
using reference::TimeStepping;
using reference::Vector;

constexpr double stiff_kn = 1000, stiff_strength = 1, stiff_cohesion = 2, stiff_energy_1 = 0.01, stiff_energy_2 = 0.03;

BondRule stiff_bond_rule() {
  BondRule rule;
  rule.first = rule.second = "all";
  rule.stiffness = stiff_kn, rule.strength = stiff_strength, rule.cohesion = stiff_cohesion;
  rule.fracture_energy = stiff_energy_1, rule.shear_fracture_energy = stiff_energy_2;
  rule.friction = 0;
  return rule;
}

/// Two unit squares, side by side, with common nodes at x = 0, or a gap there. Time runs to 1.
Scene two_squares(BodyKind kind, double gap = 0) {
  Scene scene = bare_scene();
  scene.file = "test.toml";
  scene.time.end = 1;
  scene.contacts = {frictionless(stiff_kn)};
  for (const double x : {-0.5, 0.5 + gap}) {
    ShapeSpec square = box_shape("", 1, 1, 0.25);
    if (kind == BodyKind::compliant) square.nodes = 41;
    add_body(scene, square, kind, {x, 0});
  }
  scene.bonds = {stiff_bond_rule()};
  return scene;
}

AxisCondition at_rate(double rate) {
  AxisCondition axis;
  axis.mode = AxisCondition::Mode::velocity;
  axis.history = {{0}, {rate}};
  return axis;
}

/// Moves a rigid grain along a straight line.
void drive_straight(Scene& scene, const std::string& grain, const Vec2& velocity) {
  BoundaryCondition condition;
  condition.grains = grain;
  condition.x = at_rate(velocity.x()), condition.y = at_rate(velocity.y()), condition.angle = at_rate(0);
  scene.boundary.push_back(condition);
}

struct Separation {
  double work = 0, lost = 0, stored = 0, peak = 0, balance_error = 0;
  reference::BondCounts counts;
};

Separation separate(const Scene& scene, int steps, bool statics = true) {
  System system(scene);
  reference::SolverOptions options;
  options.statics = statics;
  TimeStepping run(system, options);
  Separation found;
  for (int step = 1; step <= steps; ++step) {
    run.step(scene.time.end * step / steps);
    const reference::View view(system, run);
    const Points forces = view.contact_forces();
    const reference::Body& pulled = system.bodies().all()[1];
    Vec2 sum(0, 0);
    for (std::size_t k = 0; k < pulled.outline.size(); ++k)
      sum += forces[static_cast<std::size_t>(pulled.first_outline) + k];
    found.peak = std::max(found.peak, sum.norm());
  }
  const reference::EnergyBalance& balance = run.balance();
  found.work = balance.external_work(), found.lost = balance.dissipated_by_bonds;
  found.stored = balance.strain + balance.contact + balance.boundary;
  found.balance_error = balance.balance_error();
  found.counts = system.bonds().counts();
  return found;
}

/// EXACT: along a straight path the traction is piecewise linear in the opening, so the work of mean forces is that of
/// separation over an edge of length 1. Steps end where the traction begins to fall and where it is zero: in tension
/// at 0.001 and 0.02, in shear at 0.002 and 0.03.
TEST(ReferenceBonds, work_of_separation_in_one_mode) {
  LargestFigures figures;
  for (const bool in_shear : {false, true}) {
    Scene scene = two_squares(BodyKind::rigid);
    drive_straight(scene, "grain0", {0, 0});
    drive_straight(scene, "grain1", in_shear ? Vec2(0, 0.04) : Vec2(0.04, 0));
    const Separation found = separate(scene, 80);
    EXPECT_NEAR(found.work, in_shear ? stiff_energy_2 : stiff_energy_1, 1e-13);
    EXPECT_NEAR(found.lost, found.work, 1e-13);
    EXPECT_NEAR(found.peak, in_shear ? stiff_cohesion : stiff_strength, 1e-11);
    EXPECT_EQ(found.stored, 0);
    EXPECT_EQ(found.counts.torn, 4);
    figures.note("work of separation in one mode",
                 std::abs(found.work / (in_shear ? stiff_energy_2 : stiff_energy_1) - 1));
  }
}

/// EXACT: the linear power law of the energies, and the quadratic criterion of the strengths. A step in which the
/// slope of the traction jumps, by the stiffness at most, errs by stiffness step^2/8. There are two.
TEST(ReferenceBonds, work_of_separation_in_mixed_modes) {
  LargestFigures figures;
  for (const double angle : {0.3, 0.7, 1.2}) {
    Scene scene = two_squares(BodyKind::rigid);
    drive_straight(scene, "grain0", {0, 0});
    drive_straight(scene, "grain1", 0.04 * Vec2(std::cos(angle), std::sin(angle)));
    constexpr int steps = 1000;
    const Separation found = separate(scene, steps);
    // with equal stiffnesses the shares of the modes in the energy are cos^2 and sin^2 of the angle of the opening
    const double c = std::pow(std::cos(angle), 2), s = std::pow(std::sin(angle), 2), step = 0.04 / steps;
    const double energy = 1 / (c / stiff_energy_1 + s / stiff_energy_2);
    EXPECT_NEAR(found.work, energy, stiff_kn * step * step / 4) << angle;
    EXPECT_NEAR(found.lost, found.work, 1e-13) << angle;
    EXPECT_NEAR(found.peak, 1 / std::sqrt(c / std::pow(stiff_strength, 2) + s / std::pow(stiff_cohesion, 2)),
                stiff_kn * step)
        << angle;
    EXPECT_EQ(found.counts.torn, 4);
    figures.note("work of separation in mixed modes", std::abs(found.work / energy - 1));
  }
}

/// Pulls or slides the outer side of a compliant square.
void pull_side(Scene& scene, const std::string& grain, const Vec2& side, const Vec2& displacement) {
  BoundaryCondition support;
  support.kind = BoundaryCondition::Kind::support;
  support.grains = grain;
  support.part = {.kind = OutlinePart::Kind::side, .side = side};
  support.stiffness = 1e6;
  support.x = at_rate(displacement.x()), support.y = at_rate(displacement.y());
  scene.boundary.push_back(support);
}

/// EXACT: with one strength, energy and stiffness in both modes the work of separation is the same on any path. Squares
/// of 1e4 times the strength deform, and their elastic energy is zero again in the end. Steps err as above.
TEST(ReferenceBonds, work_of_separation_of_compliant_squares) {
  LargestFigures figures;
  for (const Vec2& direction : {Vec2(1, 0), Vec2(0, 1), Vec2(0.6, 0.8)}) {
    Scene scene = two_squares(BodyKind::compliant);
    scene.materials[0].young = 1e4;
    scene.bonds[0].cohesion = stiff_strength, scene.bonds[0].shear_fracture_energy = stiff_energy_1;
    pull_side(scene, "grain0", {-1, 0}, {0, 0});
    pull_side(scene, "grain1", {1, 0}, 0.03 * direction);
    constexpr int steps = 150;
    const double step = 0.03 / steps;
    const Separation found = separate(scene, steps);
    EXPECT_NEAR(found.work, stiff_energy_1, 2 * stiff_kn * step * step / 4);
    EXPECT_NEAR(found.lost, found.work, 2 * stiff_kn * step * step / 4);
    EXPECT_LT(found.stored, 1e-10 * stiff_energy_1);
    EXPECT_EQ(found.counts.torn, 4);
    figures.note("work of separation of compliant squares", std::abs(found.work / stiff_energy_1 - 1));
    figures.note("energy balance of compliant squares", found.balance_error);
  }
}

/// Unmatched compliant and rigid outlines in a chain over the border of the period, cemented to each other and to a
/// floor, which contact with friction supports.
Scene cemented() {
  Scene scene = nodal_scene();
  scene.file = "test.toml";
  scene.contacts = {mohr_coulomb(130, 0.3)};
  scene.period = 3;
  add_body(scene, outline_shape("", rectangle(1.5, 1, 0.21), 40), BodyKind::compliant, {0.7, 0.505});
  add_body(scene, outline_shape("", rectangle(1.49, 1, 0.26)), BodyKind::rigid, {2.2, 0.503}, 0.003);
  scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 0.37)};
  BondRule rule = stiff_bond_rule();
  rule.gap = 0.03;
  rule.stiffness = 100, rule.shear_stiffness = 70;
  rule.fracture_energy = 0.03, rule.shear_fracture_energy = 0.05, rule.friction = 0.6;
  scene.bonds = {rule};
  return scene;
}

/// At rest, stirred at random from the start.
Motion stirred(const System& system, double size, std::uint64_t seed) {
  Random random(seed);
  Motion motion{system.bodies().initial_positions(), system.bodies().initial_velocities(), 0};
  motion.moves = false;
  for (int i = 0; i < motion.q.size(); ++i) motion.q[i] += random.uniform(-size, size);
  return motion;
}

/// INDEPENDENT: central differences, whose remainder is of third derivatives x step^2/6. Over the stiffness these are
/// 1/0.01^2, as damage changes over displacements of 0.01: 1.5e-10. Ten times that are allowed. A kink within the step
/// would be seen as far more.
TEST(ReferenceBonds, tangent_is_the_derivative_of_the_residual) {
  LargestFigures figures;
  int softening = 0;
  for (const int seed : {1, 2, 3}) {
    Scene scene = cemented();
    if (seed == 2) scene.bonds[0].fatigue_rate = 0.3, scene.bonds[0].shear_fatigue_rate = 0.5;
    System system(scene);
    system.evaluate(stirred(system, 0, 0), false);
    system.accept();
    ASSERT_GT(system.bonds().all().size(), 15u);
    system.evaluate(stirred(system, 0.02, static_cast<std::uint64_t>(seed)), false);
    system.accept();
    softening += system.bonds().counts().softening;
    // Further on the same way, so that damage grows at most ends; back; and another way.
    for (const Motion& motion : {stirred(system, 0.022, static_cast<std::uint64_t>(seed)),
                                 stirred(system, 0.012, static_cast<std::uint64_t>(seed)), stirred(system, 0.03, 9)}) {
      const double error = tangent_error(system, motion, true, 3e-7);
      EXPECT_LT(error, 1.5e-9) << seed;
      figures.note("tangent of bonds", error);
    }
  }
  EXPECT_GT(softening, 10);
}

/// EXACT: forces have a potential as long as damage does not grow, and are said to have none else.
TEST(ReferenceBonds, potential_while_damage_rests) {
  Scene scene = cemented();
  scene.contacts = {frictionless(130)};
  System system(scene);
  system.evaluate(stirred(system, 0.02, 5), false);
  system.accept();
  const Motion back = stirred(system, 0.015, 5);
  const Forces at = system.evaluate(back, true);
  ASSERT_TRUE(at.symmetric);
  EXPECT_LT(reference::SparseMatrix(at.stiffness - reference::SparseMatrix(at.stiffness.transpose())).norm(),
            1e-12 * at.stiffness.norm());
  EXPECT_EQ(at.bond_loss, 0);
  Random random(6);
  const double h = 1e-6;
  for (int sample = 0; sample < 5; ++sample) {
    Vector step(back.q.size());
    for (int i = 0; i < step.size(); ++i) step[i] = random.uniform(-1, 1);
    Motion up = back, down = back;
    up.q += h * step, down.q -= h * step;
    const double change = (system.evaluate(up, false).potential - system.evaluate(down, false).potential) / (2 * h);
    EXPECT_NEAR(change, at.residual.dot(step), 1e-8 * at.residual.cwiseAbs().dot(step.cwiseAbs()));
  }
  const Forces further = system.evaluate(stirred(system, 0.03, 5), true);
  EXPECT_FALSE(further.symmetric);
  EXPECT_GT(further.bond_loss, 0);
}

/// EXACT: forces of bonds have neither a sum nor a moment.
TEST(ReferenceBonds, conserve_both_momenta) {
  Scene scene = cemented();
  scene.period.reset(), scene.walls.clear();
  System system(scene);
  const Motion motion = stirred(system, 0.02, 7);
  const Forces forces = system.evaluate(motion, false);
  const Points x = system.bodies().outline_positions(motion.q);
  Points on_nodes(x.size(), Vec2(0, 0));
  reference::add_forces(forces.bonds, on_nodes);
  Vec2 sum(0, 0);
  double moment = 0, magnitude = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += on_nodes[i], moment += cross(x[i], on_nodes[i]), magnitude += on_nodes[i].lpNorm<1>();
  ASSERT_GT(magnitude, 1);
  EXPECT_LT(sum.norm(), 1e-14 * magnitude);
  EXPECT_LT(std::abs(moment), 1e-14 * magnitude);
}

/// INDEPENDENT: the moments from which the stress of a cell takes its share of gaps are the derivative of the energy by
/// a homogeneous deformation of everything. Central differences by 1e-6 are off by 1e-12 of third derivatives.
TEST(ReferenceBonds, moments_are_the_derivative_by_deformation) {
  Scene scene = cemented();
  scene.period.reset(), scene.walls.clear();
  scene.bonds[0].strength = 1e3, scene.bonds[0].cohesion = 1e3;
  scene.bonds[0].fracture_energy = 1e6, scene.bonds[0].shear_fracture_energy = 1e6;
  const System system(scene);
  const reference::Periods none = system.periods(0);
  reference::Bonds bonds(scene, system.bodies().contact_outlines());
  bonds.make(system.bodies().outline_positions(system.bodies().initial_positions()), none, 0);
  const Points x = system.bodies().outline_positions(stirred(system, 0.02, 8).q);
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (const reference::BondElement& element : bonds.evaluate(x, none).elements) moment += element.lever.moment;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const auto energy = [&](double step) {
        Eigen::Matrix2d deformation = Eigen::Matrix2d::Identity();
        deformation(i, j) += step;
        Points moved = x;
        for (Vec2& point : moved) point = deformation * point;
        return bonds.evaluate(moved, none).stored;
      };
      EXPECT_NEAR((energy(1e-6) - energy(-1e-6)) / 2e-6, moment(i, j), 1e-8 * moment.norm());
    }
}

/// EXACT: cells of a grain touch along common edges, with common nodes, and press on each other by rounding alone.
TEST(ReferenceBonds, cells_touch_without_force) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Scene scene = bare_scene();
    scene.contacts = {mohr_coulomb(100, 0.3)};
    scene.contact.quadrature = ContactQuadrature::segments;
    scene.shapes = {disc_shape("disc", 2, 220)};
    add_grain(scene, "disc", BodyKind::compliant, {0.3, 0.2});
    scene.grains[0].cells.assign(6, 1.0), scene.grains[0].seed = seed;
    scene.bonds = {stiff_bond_rule()};
    scene.bonds[0].friction = 0.3;
    System system(scene);
    Motion motion = stirred(system, 0, 0);
    const Forces forces = system.evaluate(motion, true);
    EXPECT_LT(forces.residual.cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_TRUE(std::isfinite(forces.stiffness.norm()));
    EXPECT_EQ(system.bonds().counts().whole, static_cast<int>(system.bonds().all().size()));
  }
}

/// EXACT: bonds are made where the bodies are at that time, at which a step ends, and are free of stress there.
TEST(ReferenceBonds, are_made_at_their_time) {
  for (const bool statics : {true, false}) {
    Scene scene = two_squares(BodyKind::rigid);
    drive_straight(scene, "grain0", {0, 0});
    drive_straight(scene, "grain1", {0.001, 0});
    scene.bonds[0].from = 0.25, scene.bonds[0].gap = 0.01;
    System system(scene);
    reference::SolverOptions options;
    options.statics = statics;
    TimeStepping run(system, options);
    run.step(0.2);
    EXPECT_TRUE(system.bonds().all().empty());
    run.step(0.4);
    ASSERT_EQ(system.bonds().all().size(), 4u);
    EXPECT_NEAR(system.bonds().all()[0].rest_gap[0], 0.00025, 1e-15);
    EXPECT_NEAR(run.forces().bonds.stored, 0.5 * stiff_kn * std::pow(0.00015, 2), 1e-15);
    EXPECT_LT(run.balance().balance_error(), 1e-12);
  }
}

TEST(ReferenceBonds, refuse_what_they_do_not_have) {
  EXPECT_THROW(System{two_squares(BodyKind::rigid, 0.1)}, InputError);
  const auto refused = [](const auto& change) {
    Scene scene = two_squares(BodyKind::rigid);
    change(scene.bonds[0]);
    EXPECT_THROW(System{scene}, InputError);
  };
  refused([](BondRule& rule) { rule.fracture_energy = stiff_strength * stiff_strength / (2 * stiff_kn); });
  refused([](BondRule& rule) { rule.weibull_modulus = 4; });
}

}  // namespace
}  // namespace pliant::reference_tests
