// Bodies that keep their energy (docs/method.md 6): their energy error, and its correction.
#include "dynamics/body_energy_correction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bodies/node_arrays.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "dynamics/energy.hpp"
#include "dynamics/verlet.hpp"
#include "setup/build_model.hpp"
#include "support/bench.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

/// Two discs of one shape.
Scene discs_moving(const InitialVelocity& velocity, Mass mass, double mass_scaling) {
  Scene scene = free_disc(60, 1);
  scene.grains = {grains("discs", "disc", BodyKind::compliant, {{0, 0}, {3, 1}}, velocity)};
  scene.discretisation.mass = mass;
  scene.discretisation.mass_scaling = mass_scaling;
  return scene;
}

/// They ring, travel and turn.
Scene ringing_discs(Mass mass, double mass_scaling = 1) {
  InitialVelocity velocity = stretching(0.3);
  velocity.uniform = {0.1, -0.2};
  velocity.rotation = 0.2;
  return discs_moving(velocity, mass, mass_scaling);
}

/// A step of no length that led to where a state is.
Trial standing_still(const Bench& bench) {
  Trial before(bench.model);
  before.position = bench.state.position, before.force = bench.state.force;
  return before;
}

double total_error(const BodyEnergyCorrection& correction, const Bench& bench) {
  const Trial before = standing_still(bench);
  double total = 0;
  for (int b = 0; b < static_cast<int>(bench.model.batches.size()); ++b) {
    const Lanes error = correction.error(before, bench.state, b, 0);
    total += bench.model.batches[b].layout == Layout::nodewise ? error[0] : sum(error);
  }
  return total;
}

/// Momentum and angular momentum of all compliant nodes about the fixed centres of their bodies.
Eigen::Vector3d momenta(const Bench& bench) {
  Eigen::Vector3d total(0, 0, 0);
  for (const Batch& batch : bench.model.batches)
    with_nodes(bench.model, batch, [&](const auto& nodes) {
      const Lanes *q = &bench.state.position.compliant[batch.offset],
                  *y = &bench.state.reduced_momentum.compliant[batch.offset];
      Lanes px{}, py{}, turning{};
      for (int i = 0; i < batch.slots; ++i) {
        const Lanes mass = nodes.mass_at_unit_density[i] * select(batch.weight > 0.0, batch.density, Lanes{});
        px += mass * y[2 * i], py += mass * y[2 * i + 1];
        turning += mass * (q[2 * i] * y[2 * i + 1] - q[2 * i + 1] * y[2 * i]);
      }
      total += Eigen::Vector3d(sum(px), sum(py), sum(turning));
    });
  return total;
}

void make_faster(State& state, double share) {
  for (Lanes& y : state.reduced_momentum.compliant) y *= 1 + share;
}

struct MassCase {
  Mass mass;
  double mass_scaling;
  BuildOptions options;
};

class BodyEnergyError : public ::testing::TestWithParam<MassCase> {};

TEST_P(BodyEnergyError, is_excess_energy_and_is_removed_from_vibrations) {
  const auto& [mass, mass_scaling, options] = GetParam();
  Bench bench(build_model(ringing_discs(mass, mass_scaling), options));
  const BodyEnergyCorrection correction(bench.model);
  ASSERT_TRUE(correction.is_active());
  correction.correct(standing_still(bench), bench.state, 0);  // starts the balance
  const auto kinetic = [&] { return kinetic_energy(bench.model, bench.state.reduced_momentum); };
  const double start = kinetic();
  make_faster(bench.state, 1e-5);
  const double faster = kinetic(), error = total_error(correction, bench);
  EXPECT_NEAR(error, faster - start, 1e-14 * start) << "INDEPENDENT: kinetic energy";

  const Eigen::Vector3d before = momenta(bench);
  correction.correct(standing_still(bench), bench.state, 0);
  const double removed = faster - kinetic();
  EXPECT_LT((momenta(bench) - before).cwiseAbs().maxCoeff(), 1e-14 * before.cwiseAbs().maxCoeff())
      << "EXACT: momentum and angular momentum stay";
  EXPECT_NEAR(total_error(correction, bench), error - removed, 1e-14 * start) << "INDEPENDENT: kinetic energy";
  EXPECT_NEAR(removed, corrected_share * error, largest_correction_of_bodies * error)
      << "EXACT: but for the square of a small change";
}

/// A rotation is no vibration, whatever the mass matrix: nothing is taken from it.
TEST_P(BodyEnergyError, waits_while_a_body_only_turns) {
  const auto& [mass, mass_scaling, options] = GetParam();
  InitialVelocity velocity;
  velocity.rotation = 0.2;
  Bench bench(build_model(discs_moving(velocity, mass, mass_scaling), options));
  const BodyEnergyCorrection correction(bench.model);
  correction.correct(standing_still(bench), bench.state, 0);
  make_faster(bench.state, 1e-5);
  const Dofs before = bench.state.reduced_momentum;
  correction.correct(standing_still(bench), bench.state, 0);
  EXPECT_EQ(kinetic_energy(bench.model, bench.state.reduced_momentum), kinetic_energy(bench.model, before)) << "EXACT";
}

const MassCase cases[] = {{Mass::lumped, 1, {1 << 30, true, {}}}, {Mass::lumped, 1, {1 << 30, true, {1, 0.1}}},
                          {Mass::lumped, 1, {0, false, {}}},      {Mass::lumped, 3, {1 << 30, true, {}}},
                          {Mass::lumped, 3, {0, false, {}}},      {Mass::corrected, 1, {1 << 30, true, {}}},
                          {Mass::corrected, 1, {0, false, {}}}};
INSTANTIATE_TEST_SUITE_P(LanesAndNodewise, BodyEnergyError, ::testing::ValuesIn(cases));

TEST(BodyEnergyCorrection, take_a_hundred_thousandth_a_step_at_most) {
  Bench bench(ringing_discs(Mass::lumped));
  const BodyEnergyCorrection correction(bench.model);
  correction.correct(standing_still(bench), bench.state, 0);
  make_faster(bench.state, 0.02);
  const std::vector<Lanes> before = bench.state.reduced_momentum.compliant;
  correction.correct(standing_still(bench), bench.state, 0);
  double change = 0, reach = 0;  // of a disc as it was meshed vibrations are the stretching
  for (std::size_t i = 0; i < before.size(); ++i) {
    change = std::max(change, std::abs(before[i][0] - bench.state.reduced_momentum.compliant[i][0]));
    reach = std::max(reach, std::abs(bench.state.position.compliant[i][0]));
  }
  EXPECT_NEAR(change, largest_correction_of_bodies * 1.02 * 0.3 * reach, 1e-15)
      << "EXACT: stretched by 0.3 x, faster by 2 %";
}

TEST(BodyEnergyCorrection, wait_where_there_is_less_to_take_from) {
  Bench bench(ringing_discs(Mass::lumped));
  const BodyEnergyCorrection correction(bench.model);
  correction.correct(standing_still(bench), bench.state, 0);
  make_faster(bench.state, 0.5);  // error is 1.25 times all kinetic energy, of which vibrations have 0.4
  const Dofs before = bench.state.reduced_momentum;
  correction.correct(standing_still(bench), bench.state, 0);
  EXPECT_EQ(kinetic_energy(bench.model, bench.state.reduced_momentum), kinetic_energy(bench.model, before)) << "EXACT";
}

TEST(BodyEnergyCorrection, are_kept_where_energy_has_no_other_way) {
  const auto kept = [](auto&& change) {
    Scene scene = ringing_discs(Mass::lumped);
    change(scene);
    return BodyEnergyCorrection(build_model(scene)).is_active();
  };
  EXPECT_TRUE(kept([](Scene&) {}));
  EXPECT_FALSE(kept([](Scene& scene) { scene.materials[0].viscosity = 0.1; }));
  EXPECT_FALSE(kept([](Scene& scene) { scene.materials[0].mass_damping = 0.1; }));
  EXPECT_FALSE(kept([](Scene& scene) { scene.materials[0].law = MaterialLaw::neo_hookean_maxwell; }));
  EXPECT_FALSE(kept([](Scene& scene) { scene.materials[0].law = MaterialLaw::von_mises; }));
  EXPECT_FALSE(kept([](Scene& scene) { scene.contact.energy_consistent = false; }));
  EXPECT_FALSE(kept([](Scene& scene) { scene.gravity_history = {{{0, 1}, {0, 1}}, constant(0)}; }));
  EXPECT_FALSE(kept([](Scene& scene) { scene.grains = {grains("hard", "disc", BodyKind::rigid, {{0, 0}})}; }));
}

/// Off their line of centres.
Scene two_discs_meet(MaterialLaw law) {
  Scene scene = free_disc(30, 20);
  scene.materials[0].law = law;
  scene.grains = {grains("left", "disc", BodyKind::compliant, {{0, 0}}, moving({0.2, 0})),
                  grains("right", "disc", BodyKind::compliant, {{2.1, 0.4}}, moving({-0.2, 0}))};
  without_error_control(scene, 1);
  return scene;
}

/// Of each body of a batch, (dt^2 sum F F_before/m - sum dx dF)/12, ways and forces without the body's mean: what a
/// body has as an energy error if the work of the mean of its forces is what they store, J/m. It is the same whoever
/// looks on.
Lanes owed_by_linear(const Bench& bench, const Trial& before, const Batch& batch, double dt) {
  Dofs kick = before.force, response;
  Lanes way[2]{};
  with_nodes(bench.model, batch, [&](const auto& nodes) {
    Lanes mass{}, kick_of_all[2]{};
    for (int i = 0; i < batch.slots; ++i) mass += nodes.mass_at_unit_density[i];
    for (int i = 0; i < 2 * batch.slots; ++i) {
      const std::size_t at = batch.offset + static_cast<std::size_t>(i);
      kick_of_all[i % 2] += kick.compliant[at] / mass * batch.inverse_density;
      way[i % 2] += nodes.mass_at_unit_density[i / 2] / mass *
                    (bench.state.position.compliant[at] - before.position.compliant[at]);
    }
    for (int i = 0; i < 2 * batch.slots; ++i) {
      Lanes& of_node = kick.compliant[batch.offset + static_cast<std::size_t>(i)];
      of_node = of_node * nodes.inverse_mass_at_unit_density[i / 2] * batch.inverse_density - kick_of_all[i % 2];
    }
  });
  const Dofs& moving = material_velocity(bench.model, kick, response);
  Lanes total{};
  for (std::size_t i = batch.offset; i < batch.offset + 2 * static_cast<std::size_t>(batch.slots); ++i)
    total += dt * dt * bench.state.force.compliant[i] * moving.compliant[i] -
             (bench.state.position.compliant[i] - before.position.compliant[i] - way[(i - batch.offset) % 2]) *
                 (bench.state.force.compliant[i] - before.force.compliant[i]);
  return total / 12;
}

struct Errors {
  double largest = 0;     ///< of one body's, J/m
  double off_linear = 0;  ///< largest difference from owed_by_linear, J/m
  double lost = 0;        ///< largest loss of kinetic energy, J/m
};

/// In equal steps, across corrections too.
Errors errors_over(const Scene& scene, double dt, double end) {
  Bench bench(scene);
  Verlet verlet(bench.forces, bench.state);
  const BodyEnergyCorrection correction(bench.model);
  bench.state.steps = -1;  // so that the first step starts the balance
  const double start = kinetic_energy(bench.model, bench.state.reduced_momentum);
  Errors result;
  for (int step = 0; step < std::lround(end / dt); ++step) {
    bench.control.next_dt = dt;
    take_step(verlet, bench.forces, bench.state, bench.control, 1e9);
    result.lost = std::max(result.lost, start - kinetic_energy(bench.model, bench.state.reduced_momentum));
    for (int b = 0; b < static_cast<int>(bench.model.batches.size()); ++b) {
      const Batch& batch = bench.model.batches[b];
      const Lanes each = correction.error(verlet.trial(), bench.state, b, dt),
                  off = each - owed_by_linear(bench, verlet.trial(), batch, dt);
      for (int lane = 0; lane < batch.count; ++lane) {
        result.largest = std::max(result.largest, std::abs(each[lane]));
        result.off_linear = std::max(result.off_linear, std::abs(off[lane]));
      }
    }
  }
  return result;
}

/// The work of the mean of linear forces is what they store, in touch as well.
TEST(BodyEnergyCorrection, of_linear_bodies_are_those_of_the_moment) {
  for (const Mass mass : {Mass::lumped, Mass::corrected}) {
    Scene scene = two_discs_meet(MaterialLaw::linear_elastic);
    scene.discretisation.mass = mass;
    const Errors errors = errors_over(scene, 0.02, 3.9);  // up to the first correction
    EXPECT_GT(errors.lost, 0.01) << "or they did not meet";
    EXPECT_LT(errors.off_linear, 1e-13 * errors.lost) << "EXACT: rounding of some hundred steps";
    EXPECT_GT(errors.largest, 1e-6 * errors.lost) << "or there is nothing to see";
  }
}

/// Of free linear bodies nothing flickers.
TEST(BodyEnergyCorrection, of_linear_bodies_that_ring_are_none) {
  for (const Mass mass : {Mass::lumped, Mass::corrected}) {
    Scene scene = free_disc(30, 20, stretching(0.01));
    scene.materials[0].law = MaterialLaw::linear_elastic;
    scene.discretisation.mass = mass;
    without_error_control(scene, 1);
    const Bench start(scene);
    const double energy = kinetic_energy(start.model, start.state.reduced_momentum);
    EXPECT_LT(errors_over(scene, 0.05, 9.9).largest, 1e-13 * energy) << "EXACT: rounding of some hundred steps";
  }
}

void expect_order(const Scene& scene, const std::vector<double>& steps, double end, double order, double tolerance) {
  std::vector<double> error;
  for (const double dt : steps) error.push_back(errors_over(scene, dt, end).largest);
  for (std::size_t i = 0; i + 1 < error.size(); ++i)
    EXPECT_NEAR(observed_order(error[i], error[i + 1]), order, tolerance)
        << "RATE: " << error[i] << ", " << error[i + 1];
}

TEST(BodyEnergyCorrection, of_bodies_that_meet_fall_with_the_square_of_the_step) {
  expect_order(two_discs_meet(MaterialLaw::neo_hookean), {0.02, 0.01, 0.005}, 4, 2, 0.3);
}

/// What velocity Verlet keeps of nonlinear vibrations, but for half of the last step's gain; without the terms of the
/// step, errors fall with the square.
TEST(BodyEnergyCorrection, of_a_free_body_fall_with_the_third_power_of_the_step) {
  Scene scene = free_disc(60, 20, stretching(0.1));
  without_error_control(scene, 1);
  expect_order(scene, {0.04, 0.02, 0.01}, 20, 3, 0.5);
}

TEST(BodyEnergyCorrection, a_fall_has_none) {
  Scene scene = free_disc(30, 20, moving({0.1, 0.3}));
  scene.gravity = {0.02, -0.2};
  without_error_control(scene, 1);
  const double weight = 0.2 * M_PI, fallen = 0.5 * 0.2 * 25 - 0.3 * 5;
  EXPECT_LT(errors_over(scene, 0.02, 5).largest, 1e-13 * weight * fallen) << "EXACT: rounding of steps";
}

}  // namespace
}  // namespace pliant::dynamics_tests
