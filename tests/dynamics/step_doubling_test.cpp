// The paper's scheme: order one, its estimator, and how its controller holds the error (docs/method.md 6).
#include "dynamics/step_doubling.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "setup/build_model.hpp"
#include "support/bench.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

Scene doubling_disc() {
  Scene scene = free_disc(60, 1e9, stretching(0.3));
  scene.time.integrator = Integrator::step_doubling;
  scene.time.target = 1e300;  // no control: the tests give the steps
  return scene;
}

/// The state after 3 time units in equal steps.
State doubled_swing(double dt) {
  Bench bench(doubling_disc());
  StepDoubling integrator(bench.forces, bench.state);
  for (int step = 0; step < std::lround(3 / dt); ++step) {
    bench.control.next_dt = dt;
    take_step(integrator, bench.forces, bench.state, bench.control, 1e9);
  }
  return bench.state;
}

TEST(StepDoubling, order_one) {
  const State states[] = {doubled_swing(0.005), doubled_swing(0.0025), doubled_swing(0.00125), doubled_swing(0.000625)};
  for (int i = 0; i < 2; ++i) {
    const double order = observed_order(distance(states[i], states[i + 1]), distance(states[i + 1], states[i + 2]));
    EXPECT_NEAR(order, 1, 0.1) << "RATE";
  }
}

/// One state in both schemes' words: semi-implicit Euler, a = F/M; v += dt a; u += dt v.
struct Euler {
  Dofs position, velocity;
};

void euler_step(const Model& model, Euler& state, const Dofs& force, double dt) {
  for (const Batch& batch : model.batches)
    for (int i = 0; i < 2 * model.shape_of(batch).nodes(); ++i) {
      const std::size_t at = batch.offset + static_cast<std::size_t>(i);
      const Lanes mass = model.shape_of(batch).space.mass_at_unit_density[i / 2] * batch.density;
      state.velocity.compliant[at] += dt * force.compliant[at] / mass;
      state.position.compliant[at] += dt * state.velocity.compliant[at];
    }
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    for (std::size_t c = 0; c < 3; ++c) {
      const RigidDof& dof = model.rigid_bodies[r].dof[c];
      if (dof.imposed()) continue;
      state.velocity.rigid[3 * r + c] += dt * force.rigid[3 * r + c] / dof.mass;
      state.position.rigid[3 * r + c] += dt * state.velocity.rigid[3 * r + c];
    }
}

/// Outline or field nodes of a body, where the error is measured.
Points nodes_of(const Model& model, const Body& body, const Dofs& position) {
  Points nodes;
  if (body.kind == BodyKind::rigid) {
    const Eigen::Vector3d x = rigid(position, body.rigid);
    for (const Vec2& p : model.outlines[body.outline].points)
      nodes.push_back(x.head<2>() + Eigen::Rotation2Dd(x[2]) * p);
    return nodes;
  }
  const ShapeRows& rows = model.shape_of(model.batches[body.batch]).space.node_rows;
  for (std::size_t k = 0; k + 1 < rows.start.size(); ++k) {
    Vec2 x(0, 0);
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e)
      x += rows.value[e] * node_value(model, body, position, rows.node[e]);
    nodes.push_back(x);
  }
  return nodes;
}

double distance_at(const Model& model, const Body& body, std::size_t node) {
  if (body.kind == BodyKind::rigid) return model.outlines[body.outline].spacing;
  return model.shape_of(model.batches[body.batch]).space.nodal_distance[node];
}

/// max |u2 - u1| / d over all nodes of all bodies, componentwise.
double largest_relative_difference(const Model& model, const Dofs& one, const Dofs& two) {
  double largest = 0;
  for (const Body& body : model.bodies) {
    const Points a = nodes_of(model, body, one), b = nodes_of(model, body, two);
    for (std::size_t k = 0; k < a.size(); ++k)
      largest = std::max(largest, (b[k] - a[k]).norm() / distance_at(model, body, k));
  }
  return largest;
}

/// A spinning rigid disc that a compliant one hits off its centre: both kinds matter for the error, one after the
/// other.
Scene collision() {
  Scene scene = empty_scene(2);
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("soft", "disc", BodyKind::compliant, {{0, 0}}, moving({0.3, 0})),
                  grains("hard", "disc", BodyKind::rigid, {{2.05, 0.7}}, moving({0, 0}, 2))};
  scene.contacts = {mohr_coulomb(100, 0.3)};
  scene.time.integrator = Integrator::step_doubling;
  return scene;
}

/// A time after a state, from its memory.
Dofs force_at(Forces& forces, const State& before, const Euler& motion, double later) {
  State state = before;
  state.position = motion.position, state.reduced_momentum = motion.velocity, state.time += later;
  Trial trial(forces.model());
  evaluate_at(forces, state, trial);
  return trial.force;
}

/// Follows the integrator through a scene with own steps from each of its states. Returns how many errors were
/// compared.
int compare_estimates(const Scene& scene) {
  Bench bench(scene);
  StepDoubling integrator(bench.forces, bench.state);
  int compared = 0;
  while (bench.state.time < 2) {
    const State before = bench.state;
    Forces forces = bench.forces;
    const StepReport report = take_step(integrator, bench.forces, bench.state, bench.control, 2);
    Euler one{before.position, before.reduced_momentum}, two = one;
    euler_step(bench.model, one, before.force, report.dt);
    euler_step(bench.model, two, before.force, report.dt / 2);
    euler_step(bench.model, two, force_at(forces, before, two, report.dt / 2), report.dt / 2);
    const double expected = largest_relative_difference(bench.model, one.position, two.position);
    // EXACT but for cancellation: differences of 1e-4 d between positions of order 1, to 1e-16 each.
    EXPECT_NEAR(report.error, expected, 1e-14 + 1e-9 * expected) << "EXACT, t = " << before.time;
    compared += report.error > 0;
  }
  return compared;
}

TEST(StepDoubling, estimator_compares_one_step_with_two_halves) {
  EXPECT_GT(compare_estimates(collision()), 50);
  Scene rigid_pair = collision();
  rigid_pair.grains[0].species[0] = {BodyKind::rigid, "hard", 1};
  EXPECT_GT(compare_estimates(rigid_pair), 10);
}

TEST(StepDoubling, keeps_the_two_half_steps) {
  Bench bench(collision());
  StepDoubling integrator(bench.forces, bench.state);
  while (bench.state.time < 0.5) take_step(integrator, bench.forces, bench.state, bench.control, 2);
  const State before = bench.state;
  Forces forces = bench.forces;
  const StepReport report = take_step(integrator, bench.forces, bench.state, bench.control, 2);
  Euler two{before.position, before.reduced_momentum};
  euler_step(bench.model, two, before.force, report.dt / 2);
  euler_step(bench.model, two, force_at(forces, before, two, report.dt / 2), report.dt / 2);
  EXPECT_LT(largest_relative_difference(bench.model, two.position, bench.state.position), 1e-14) << "EXACT: rounding";
  EXPECT_LT(largest_relative_difference(bench.model, two.velocity, bench.state.reduced_momentum), 1e-14)
      << "EXACT: rounding";
}

/// EXACT: dashpots know a body as immovable from 0.1 to 0.2, and both halves of a step have the same laws.
TEST(StepDoubling, passes_times_at_which_laws_change) {
  Scene scene = on_a_floor(0.4, 8, 0.25, {0, -0.1});
  scene.time.integrator = Integrator::step_doubling;
  scene.shapes = {box_shape("block", 1, 0.5, 0.25)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{2, 0.26}}, moving({0, -0.1}))};
  scene.contacts = {frictionless(100)};
  scene.contacts[0].restitution = 0.5;
  BoundaryCondition held;
  held.grains = "block";
  held.x = {AxisCondition::Mode::velocity, constant(0.1), 0, {0.1, 0.2}};
  held.y = {AxisCondition::Mode::velocity, constant(0), 0, {0.1, 0.2}};
  scene.boundary = {held};
  const Model model = build_model(scene);
  Simulation simulation(model);
  for (const double time : {0.1, 0.2, 0.4}) {
    while (simulation.state().time < time) simulation.step(time);
    EXPECT_EQ(simulation.state().time, time);
    if (time == 0.2) EXPECT_NEAR(simulation.state().position.rigid[0], 2.01, 1e-14);
  }
}

TEST(StepDoubling, accepts_no_error_above_alpha_times_its_target) {
  const Model model = build_model(collision());
  Simulation simulation(model);
  const double limit = model.scene.time.alpha * model.scene.time.target;
  while (simulation.state().time < 2) EXPECT_LE(simulation.step(2).error, limit) << "EXACT: more is rejected";
  EXPECT_GT(simulation.state().rejections, 0) << "no error was large enough for this test to say anything";
}

TEST(StepDoubling, controller_holds_the_error_at_its_target) {
  Scene scene = small_third_body(2);
  scene.time.integrator = Integrator::step_doubling;
  const Model model = build_model(scene);
  Simulation simulation(model);
  std::vector<double> errors;
  while (simulation.state().time < 2) {
    const StepReport report = simulation.step(2);
    if (simulation.state().time > 0.4) errors.push_back(report.error);
  }
  ASSERT_GT(errors.size(), 100u);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  const double median = errors[errors.size() / 2] / scene.time.target;
  EXPECT_GT(median, 0.5) << "INDEPENDENT: the paper's figure 8 holds the target";
  EXPECT_LT(median, 1.5);
}

TEST(StepDoubling, steps_end_exactly_on_output_times) {
  Scene scene = collision();
  const Model model = build_model(scene);
  Simulation simulation(model);
  for (int output = 1; output <= 20; ++output) {
    advance(simulation, 0.1 * output);
    EXPECT_EQ(simulation.state().time, 0.1 * output) << "EXACT";
  }
}

}  // namespace
}  // namespace pliant::dynamics_tests
