// Bonds that tear in motion: the engine against the reference solver.
#include <gtest/gtest.h>

#include <numeric>

#include "reference/both.hpp"
#include "reference/outputs/view.hpp"
#include "support/figures.hpp"
#include "support/simulations.hpp"

namespace pliant::reference_tests {
namespace {

using namespace dynamics_tests;

constexpr double strength = 0.2, energy_1 = 0.002, energy_2 = 0.004, end = 0.6;
constexpr int outputs = 60;

/// Two squares of E = 1, joined at x = 0. All matter moves away from there at first, with a shear.
Scene pulled_apart() {
  Scene scene = bare_scene();
  scene.file = "test.toml";
  scene.time.end = end;
  scene.contacts = {frictionless(kn)};
  scene.contact.energy_consistent = false;  // the reference solver has no energy correction
  for (const double x : {-0.5, 0.5}) {
    ShapeSpec square = box_shape("", 1, 1, 0.125);
    square.nodes = 120;
    add_body(scene, square, BodyKind::compliant, {x, 0});
    InitialVelocity& velocity = scene.grains.back().velocity;
    velocity.gradient << 0.6, 0, 0.2, 0;
    velocity.uniform = velocity.gradient * Vec2(x, 0);
  }
  BondRule rule;
  rule.first = rule.second = "all";
  rule.stiffness = kn;
  rule.strength = strength, rule.cohesion = 1.5 * strength, rule.friction = 0;
  rule.fracture_energy = energy_1, rule.shear_fracture_energy = energy_2;
  scene.bonds = {rule};
  return scene;
}

/// Forces on the second square over time, and the energy that its bonds have lost.
struct Tearing {
  std::vector<Vec2> force;
  double lost = 0;
};

Tearing tearing_by_engine(double safety) {
  Scene scene = pulled_apart();
  without_error_control(scene, safety);
  const Model model = build_model(scene);
  Simulation simulation(model);
  Tearing history;
  for (int i = 1; i <= outputs; ++i) {
    advance(simulation, end * i / outputs);
    history.force.push_back(contact_force(simulation, 1));
  }
  history.lost = simulation.state().bond_loss;
  return history;
}

Tearing tearing_by_reference(int steps_per_output) {
  ReferenceRun run(pulled_apart(), {});
  const reference::Body& pulled = run.system.bodies().all()[1];
  Tearing history;
  for (int step = 1; step <= outputs * steps_per_output; ++step) {
    run.stepping.step(end * step / (outputs * steps_per_output));
    if (step % steps_per_output != 0) continue;
    const Points forces = reference::View(run.system, run.stepping).contact_forces();
    const auto first = forces.begin() + pulled.first_outline;
    history.force.push_back(
        std::accumulate(first, first + static_cast<std::ptrdiff_t>(pulled.outline.size()), Vec2(0, 0)));
  }
  history.lost = run.stepping.balance().dissipated_by_bonds;
  EXPECT_EQ(run.system.bonds().counts().torn, 8);
  EXPECT_LT(run.stepping.balance().balance_error(), 1e-3);
  return history;
}

double largest_force_difference(const Tearing& a, const Tearing& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.force.size(); ++i) largest = std::max(largest, (a.force[i] - b.force[i]).norm());
  return largest;
}

/// INDEPENDENT: two programs with two methods of second order. The fastest vibration is that of the bonds' springs
/// between nodes, w = sqrt(2 x 12.5/0.0078) = 57. A load that grows by 1.3 a second excites it by 1.3/w = 0.022, 11 %
/// of the strength. Average acceleration lags by w t (w dt)^2/12. Until the tear at t = 0.35 this is 0.034 for
/// dt = 1/400, so forces are off by 0.4 % of the strength. Twice that is allowed for the growth of differences in
/// softening: 0.75 % there, 3 % and 12 % for dt = 1/200 and 1/100. The engine's steps are a tenth as long, or less.
TEST(BondPaths, forces_of_squares_that_are_pulled_apart) {
  LargestFigures figures;
  const Tearing engine = tearing_by_engine(0.01);
  double peak = 0;
  for (const Vec2& force : engine.force) peak = std::max(peak, force.norm());
  EXPECT_GT(peak, 0.8 * strength);
  EXPECT_LT(engine.force.back().norm(), 1e-12);
  std::vector<double> steps, errors;
  for (const int parts : {1, 2, 4}) {
    const Tearing reference = tearing_by_reference(parts);
    steps.push_back(1.0 / parts);
    errors.push_back(largest_force_difference(engine, reference) / strength);
    EXPECT_LT(errors.back(), 0.12 / (parts * parts)) << parts;
    EXPECT_NEAR(reference.lost, engine.lost, 0.12 / (parts * parts) * engine.lost) << parts;
    figures.note("force of a tear, steps of 1/" + std::to_string(100 * parts), errors.back());
    figures.note("loss of a tear, steps of 1/" + std::to_string(100 * parts),
                 std::abs(reference.lost / engine.lost - 1));
  }
  const double order = observed_order(steps, errors);
  figures.note("order of the force of a tear", order);
  EXPECT_NEAR(order, 2, 0.4) << "RATE";
}

}  // namespace
}  // namespace pliant::reference_tests
