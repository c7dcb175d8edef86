#include <gtest/gtest.h>
#include <omp.h>

#include <array>
#include <cmath>

#include "bodies/place_outlines.hpp"
#include "bonds/bond_system.hpp"
#include "bonds/fragments.hpp"
#include "contact/law_table.hpp"
#include "core/errors.hpp"
#include "support/bench.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double kn = 1000, strength = 1, cohesion = 2, energy_1 = 0.01, energy_2 = 0.03;

BondRule bond_rule() {
  BondRule rule;
  rule.first = rule.second = "all";
  rule.stiffness = kn, rule.strength = strength, rule.cohesion = cohesion;
  rule.fracture_energy = energy_1, rule.shear_fracture_energy = energy_2;
  rule.friction = 0;
  return rule;
}

/// Two unit squares, side by side, with common nodes at x = 0, or a gap there.
Scene two_squares(BodyKind kind, double gap = 0, double spacing = 0.25) {
  Scene scene = bare_scene();
  scene.contacts = {frictionless(kn)};
  scene.time.end = 1;
  ShapeSpec square = box_shape("", 1, 1, spacing);
  add_body(scene, square, kind, {-0.5, 0});
  add_body(scene, square, kind, {0.5 + gap, 0});
  scene.bonds = {bond_rule()};
  return scene;
}

/// Tiny loops gain nothing by threads, and wait for them on a busy machine.
struct OneThread {
  int before = omp_get_max_threads();
  OneThread() { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before); }
};

/// Bonds of a scene between outlines that a test moves by hand.
struct Rig {
  OneThread one_thread;
  Model model;
  LawTable laws;
  BondSystem bonds;
  OutlineField position, force;
  BondHistory history;
  BondTotals totals;
  double loss = 0;

  explicit Rig(const Scene& scene)
      : model(build_model(scene)),
        laws(model),
        bonds(model, laws),
        position(placed_outlines(model, initial_positions(model))) {
    bonds.make(position, 0, history);
  }
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  /// Forces at these positions, which the history does not follow.
  BondTotals evaluate() {
    BondHistory trial;
    force = OutlineField(model.outline_offset.back());
    return totals = bonds.add_forces(position, history, trial, force);
  }
  void accept() {
    BondHistory next;
    force = OutlineField(model.outline_offset.back());
    totals = bonds.add_forces(position, history, next, force);
    loss += totals.loss;
    history = next;
  }
  void copy_cyclic() {
    for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
      for (int i = 0; i < lane_count; ++i) {
        const int from = model.outline_offset[b] + i, to = from + model.outline_of(b).count;
        position.x[to] = position.x[from], position.y[to] = position.y[from];
      }
  }
  void move(int body, const Vec2& by) {
    for (int i = model.outline_offset[body]; i < model.outline_offset[body + 1]; ++i)
      position.x[i] += by.x(), position.y[i] += by.y();
  }
};

struct Balance {
  Vec2 momentum{0, 0};
  double moment = 0;
};

/// Momentum of compliant bodies, about the origin.
Balance momenta(const Simulation& simulation) {
  Balance sum;
  for (const Body& body : simulation.model().bodies) {
    const std::vector<double> masses = node_masses(simulation.model(), body);
    for (int i = 0; i < static_cast<int>(masses.size()); ++i) {
      const Vec2 q = body.centre + node_value(simulation.model(), body, simulation.state().position, i);
      const Vec2 p = masses[i] * node_value(simulation.model(), body, simulation.state().reduced_momentum, i);
      sum.momentum += p, sum.moment += q.x() * p.y() - q.y() * p.x();
    }
  }
  return sum;
}

TEST(Bonds, join_the_segments_of_a_common_edge) {
  Rig rig(two_squares(BodyKind::rigid));
  ASSERT_EQ(rig.bonds.bonds().size(), 4u);
  for (const Bond& bond : rig.bonds.bonds()) {
    EXPECT_DOUBLE_EQ(bond.length, 0.25);
    EXPECT_EQ(bond.xi[0], 0);
    EXPECT_EQ(bond.xi[1], 0);
  }
  rig.evaluate();
  EXPECT_LT(rig.totals.stored, 1e-28);
}

/// INDEPENDENT: differences of the energy. Outlines that do not match, of other spacings, at a distance, with
/// displacements of a third of a segment. The error of central differences is of order 1e-9 here.
TEST(Bonds, exert_the_gradient_of_their_energy_and_no_moment) {
  Scene scene = bare_scene();
  scene.contacts = {frictionless(kn)};
  add_body(scene, box_shape("", 1, 1, 0.21), BodyKind::rigid, {-0.5, 0});
  add_body(scene, box_shape("", 1, 1.1, 0.3), BodyKind::rigid, {0.52, 0.03}, 0.01);
  scene.bonds = {bond_rule()};
  scene.bonds[0].gap = 0.04;
  scene.bonds[0].strength = scene.bonds[0].cohesion.emplace(1e9);
  scene.bonds[0].fracture_energy = scene.bonds[0].shear_fracture_energy.emplace(1e30);
  Rig rig(scene);
  ASSERT_GE(rig.bonds.bonds().size(), 4u);
  Random random(3);
  for (std::size_t i = 0; i < rig.position.x.size(); ++i)
    rig.position.x[i] += random.uniform(-0.07, 0.07), rig.position.y[i] += random.uniform(-0.07, 0.07);
  rig.copy_cyclic();
  rig.evaluate();
  const OutlineField force = rig.force;
  double x = 0, y = 0, moment = 0, magnitude = 0, worst = 0;
  for (int b = 0; b < 2; ++b)
    for (int i = rig.model.outline_offset[b]; i < rig.model.outline_end(b); ++i) {
      x += force.x[i], y += force.y[i];
      moment += rig.position.x[i] * force.y[i] - rig.position.y[i] * force.x[i];
      magnitude += std::abs(force.x[i]) + std::abs(force.y[i]);
      for (std::vector<double>* component : {&rig.position.x, &rig.position.y}) {
        constexpr double step = 1e-6;
        const double at = (*component)[i];
        const auto energy = [&](double value) {
          (*component)[i] = value;
          rig.copy_cyclic();
          return rig.evaluate().stored;
        };
        const double slope = (energy(at + step) - energy(at - step)) / (2 * step);
        energy(at);
        worst = std::max(worst, std::abs(slope + (component == &rig.position.x ? force.x[i] : force.y[i])));
      }
    }
  ASSERT_GT(magnitude, 1);
  EXPECT_LT(worst, 1e-8 * magnitude);
  EXPECT_LT(std::hypot(x, y), 1e-14 * magnitude);
  EXPECT_LT(std::abs(moment), 1e-14 * magnitude);
}

/// EXACT: the work of separation over an edge of length 1, in tension, in shear and in modes between, whose shares of
/// the fracture energies add up to one. The work is that of the mean forces of steps: at the onset and at the end of
/// softening, where the slope of the traction jumps by kn at most, a step errs by kn step^2/8.
TEST(Bonds, take_their_fracture_energy_to_tear) {
  for (const double angle : {0.0, 0.3, 0.7, 1.2, M_PI / 2}) {
    Rig rig(two_squares(BodyKind::rigid));
    constexpr int steps = 4000;
    const double largest = 0.1;
    double work = 0, before = 0, peak = 0;
    for (int step = 1; step <= steps; ++step) {
      rig.move(1, largest / steps * Vec2(std::cos(angle), std::sin(angle)));
      rig.accept();
      double along = 0;
      for (int i = rig.model.outline_offset[1]; i < rig.model.outline_end(1); ++i)
        along -= rig.force.x[i] * std::cos(angle) + rig.force.y[i] * std::sin(angle);
      work += 0.5 * (before + along) * largest / steps;
      before = along;
      peak = std::max(peak, along);
    }
    // with kn = kt the shares of the modes in the energy are cos^2 and sin^2 of the angle of the opening
    const double c = std::pow(std::cos(angle), 2), s = std::pow(std::sin(angle), 2);
    const double energy = 1 / (c / energy_1 + s / energy_2);
    const double traction = 1 / std::sqrt(c / (strength * strength) + s / (cohesion * cohesion));
    EXPECT_EQ(rig.history.damage(0, 0), 1) << angle;
    EXPECT_EQ(rig.totals.stored, 0) << angle;
    EXPECT_NEAR(work, energy, kn * largest / steps * largest / steps) << angle;
    EXPECT_NEAR(rig.loss, work, 1e-13) << angle;
    EXPECT_NEAR(peak, traction, kn * largest / steps) << angle;
  }
}

/// EXACT: shear strength under a pressure, which contact bears: cohesion + tan(phi) p for bond and contact together.
TEST(Bonds, are_stronger_in_shear_under_pressure) {
  for (const double friction : {0.0, 0.3}) {
    Scene scene = two_squares(BodyKind::rigid);
    scene.contacts = {mohr_coulomb(kn, friction)};
    scene.bonds[0].friction = 0.8;
    Rig rig(scene);
    const double pressure = 1.5;
    rig.move(1, {-pressure / kn, 0});
    constexpr int steps = 4000;
    const double largest = 0.01;
    double peak = 0;
    for (int step = 1; step <= steps; ++step) {
      rig.move(1, {0, largest / steps});
      rig.accept();
      double shear = 0;
      for (int i = rig.model.outline_offset[1]; i < rig.model.outline_end(1); ++i) shear -= rig.force.y[i];
      const double by_contact = std::min(friction * pressure, kn * largest * step / steps);
      peak = std::max(peak, shear + (friction > 0 ? by_contact : 0));
    }
    EXPECT_NEAR(peak, cohesion + 0.8 * pressure, 2 * kn * largest / steps) << friction;
  }
}

/// EXACT: nothing acts on two blocks that cement joins over a gap.
TEST(Bonds, are_free_of_stress_where_they_are_made) {
  Scene scene = two_squares(BodyKind::rigid, 0.02);
  scene.bonds[0].gap = 0.05;
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 1);
  EXPECT_EQ(simulation.state().position.rigid[0], -0.5);
  EXPECT_LT(std::abs(rigid(simulation.state().reduced_momentum, 1).norm()), 1e-15);
}

/// EXACT: cement in a gap bears pressure too, before surfaces touch.
TEST(Bonds, of_cement_bear_pressure_in_a_gap) {
  Scene scene = two_squares(BodyKind::rigid, 0.02);
  scene.bonds[0].gap = 0.05;
  Rig rig(scene);
  rig.move(1, {-0.01, 0});
  rig.evaluate();
  EXPECT_NEAR(rig.totals.stored, 0.5 * kn * 0.01 * 0.01, 1e-14);
}

TEST(Bonds, are_made_at_their_time) {
  Scene scene = two_squares(BodyKind::rigid);
  scene.bonds[0].from = 0.25;
  scene.grains[1].velocity = moving({0.001, 0});
  scene.bonds[0].gap = 0.01;
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 0.25);
  EXPECT_TRUE(simulation.forces().bonds().is_empty());
  simulation.step(1);
  EXPECT_EQ(simulation.forces().bonds().bonds().size(), 4u);
  EXPECT_NEAR(simulation.forces().bonds().bonds()[0].rest_gap[0], 0.00025, 1e-12);
}

/// A pair that spins and vibrates keeps both momenta to rounding, and its energy to the order of the scheme: the bond's
/// spring swings some thirty times, at 0.8 of the stable step the energy of velocity Verlet swings by up to
/// (w dt/2)^2 = 0.64 of what vibrates: 1e-4 of 0.038 in all.
TEST(Bonds, conserve_momentum_and_energy) {
  Scene scene = two_squares(BodyKind::rigid);
  scene.grains[0].velocity = moving({0.01, 0}, 0.3);
  scene.grains[1].velocity = moving({-0.01, 0}, 0.3);
  for (auto& grains : scene.grains) grains.velocity.uniform.y() = 0.3 * grains.packing.positions[0].x();
  scene.time.end = 3;
  const Model model = build_model(scene);
  Simulation simulation(model);
  const auto momenta = [&] {
    Eigen::Vector3d sum(0, 0, 0);
    for (int r = 0; r < 2; ++r) {
      const Eigen::Vector3d q = rigid(simulation.state().position, r),
                            v = rigid(simulation.state().reduced_momentum, r);
      sum += Eigen::Vector3d(v.x(), v.y(), v.z() / 6 + q.x() * v.y() - q.y() * v.x());
    }
    return sum;
  };
  const Eigen::Vector3d before = momenta();
  const double energy = simulation.energy_balance().energy.mechanical();
  double worst = 0, stored = 0;
  while (simulation.state().time < 3) {
    simulation.step(3);
    stored = std::max(stored, simulation.state().contact_energy);
    worst = std::max(worst, std::abs(simulation.energy_balance().energy.mechanical() - energy));
  }
  EXPECT_LT((momenta() - before).norm(), 1e-12);
  EXPECT_GT(stored, 0.5e-4) << "the bond takes up half of the energy of vibration at least";
  EXPECT_LT(worst, 2e-3 * energy);
  EXPECT_EQ(simulation.state().dissipated, 0);
}

/// A disc bursts: its pieces keep both momenta to rounding. RATE: what is left of the energy balance falls by the
/// square of the step; by 4 if the safety is halved, and half of that is asked for as tears come at other steps.
TEST(Bonds, keep_the_balances_of_a_bursting_disc) {
  double error[2];
  for (const double safety : {0.8, 0.4}) {
    Scene scene = bursting_disc(6);
    scene.time.safety = safety;
    const Model model = build_model(scene);
    Simulation simulation(model);
    const Balance before = momenta(simulation);
    advance(simulation, 6);
    const BondCounts counts = count_bonds(simulation.forces().bonds(), simulation.state().memory.bonds);
    EXPECT_GT(counts.torn, counts.whole);
    EXPECT_GE(find_fragments(model, simulation.forces().bonds(), simulation.state().memory.bonds).size(), 2u);
    const Balance after = momenta(simulation);
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12) << "EXACT";
    EXPECT_LT(std::abs(after.moment - before.moment), 1e-12) << "EXACT";
    error[safety < 0.6] = simulation.balance_error(simulation.energy_balance().energy);
  }
  EXPECT_LT(error[0], 1e-3);
  EXPECT_LT(error[1], 0.5 * error[0]);
}

/// EXACT: fatigue under cycles of a constant tension p between 0 and 0.8 of the strength, with a threshold of 0.3 and
/// the rate k. Each loading adds k (w 0.8 - 0.3)^2/(2 0.7) of the whole share w, until the softening line is reached.
TEST(Bonds, wear_under_cycles) {
  Scene scene = two_squares(BodyKind::rigid);
  scene.bonds[0].fatigue_rate = 0.1, scene.bonds[0].fatigue_threshold = 0.3;
  Rig rig(scene);
  double expected = 0;
  for (int cycle = 0; cycle < 5; ++cycle) {
    for (const double to : {0.8, -0.8}) {
      rig.move(1, {to * strength / kn, 0});
      rig.accept();
    }
    expected += 0.1 * std::pow((1 - expected) * 0.8 - 0.3, 2) / (2 * 0.7);
    EXPECT_NEAR(rig.history.damage(0, 0), expected, 1e-12) << cycle;
  }
}

TEST(Bonds, refuse_what_cannot_be_bonded) {
  Scene apart = two_squares(BodyKind::rigid, 0.1);
  EXPECT_THROW(Bench{apart}, InputError);
  Scene brittle = two_squares(BodyKind::rigid);
  brittle.bonds[0].fracture_energy = strength * strength / (2 * kn);
  EXPECT_THROW(Bench{brittle}, InputError);
  Scene smooth = two_squares(BodyKind::rigid);  // smoother than the contact beside it
  smooth.contacts = {mohr_coulomb(kn, 0.3)};
  EXPECT_THROW(Bench{smooth}, InputError);
}

/// Weibull: mean 1, and the same for all bonds of a pair.
TEST(Bonds, vary_in_strength_by_pairs) {
  Scene scene = bare_scene();
  scene.contacts = {frictionless(kn)};
  ShapeSpec square = box_shape("square", 1, 1, 0.5);
  scene.shapes = {square};
  Points centres;
  for (int i = 0; i < 1001; ++i) centres.emplace_back(i, 0);
  scene.grains = {grains("row", "square", BodyKind::rigid, centres)};
  scene.bonds = {bond_rule()};
  scene.bonds[0].weibull_modulus = 4;
  scene.bonds[0].fracture_energy = scene.bonds[0].shear_fracture_energy.emplace(1);
  Rig rig(scene);
  ASSERT_EQ(rig.bonds.bonds().size(), 2000u);
  double sum = 0;
  for (std::size_t i = 0; i < 2000; i += 2) {
    EXPECT_EQ(rig.bonds.bonds()[i].strength_factor, rig.bonds.bonds()[i + 1].strength_factor);
    sum += rig.bonds.bonds()[i].strength_factor;
  }
  // standard deviation 0.28 of one, 0.009 of the mean of 1000: four of them
  EXPECT_NEAR(sum / 1000, 1, 0.036);
}

}  // namespace
}  // namespace pliant::dynamics_tests
