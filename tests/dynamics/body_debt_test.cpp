// Bodies that keep their energy (docs/method.md 6): what they owe, and how they repay it.
#include "dynamics/body_debt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bodies/node_arrays.hpp"
#include "dynamics/energy.hpp"
#include "dynamics/verlet.hpp"
#include "support/bench.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

/// Two discs of one shape that ring, travel and turn.
Scene ringing_discs(Mass mass) {
  Scene scene = free_disc(60, 1);
  InitialVelocity velocity = stretching(0.3);
  velocity.uniform = {0.1, -0.2};
  velocity.rotation = 0.2;
  scene.grains = {grains("discs", "disc", BodyKind::compliant, {{0, 0}, {3, 1}}, velocity)};
  scene.discretisation.mass = mass;
  return scene;
}

double owed_together(const BodyDebts& debts, const Bench& bench) {
  double total = 0;
  for (int b = 0; b < static_cast<int>(bench.model.batches.size()); ++b) {
    const Lanes owed = debts.owed(bench.state, b, 0);
    total += bench.model.batches[b].layout == Layout::spread ? owed[0] : sum(owed);
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
        const Lanes mass = nodes.unit_mass[i] * select(batch.weight > 0.0, batch.density, Lanes{});
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

struct Case {
  Mass mass;
  BuildOptions options;
};

class BodyDebt : public ::testing::TestWithParam<Case> {};

TEST_P(BodyDebt, is_what_bodies_have_too_much_and_repay_by_vibrations) {
  const auto& [mass, options] = GetParam();
  Bench bench(build_model(ringing_discs(mass), options));
  const BodyDebts debts(bench.model);
  ASSERT_TRUE(debts.are_kept());
  debts.settle(bench.state, 0);  // opens the books
  const auto kinetic = [&] { return kinetic_energy(bench.model, bench.state.reduced_momentum); };
  const double start = kinetic();
  make_faster(bench.state, 1e-5);
  const double faster = kinetic(), owed = owed_together(debts, bench);
  EXPECT_NEAR(owed, faster - start, 1e-14 * start) << "INDEPENDENT: kinetic energy";

  const Eigen::Vector3d before = momenta(bench);
  debts.settle(bench.state, 0);
  const double repaid = faster - kinetic();
  EXPECT_LT((momenta(bench) - before).cwiseAbs().maxCoeff(), 1e-14 * before.cwiseAbs().maxCoeff())
      << "EXACT: momentum and angular momentum stay";
  EXPECT_NEAR(owed_together(debts, bench), owed - repaid, 1e-14 * start) << "INDEPENDENT: kinetic energy";
  if (mass == Mass::lumped)
    EXPECT_NEAR(repaid, settled_share * owed, most_settled * owed) << "EXACT: but for the square of a small change";
  else
    EXPECT_TRUE(repaid > settled_share * owed && repaid < 2 * settled_share * owed)
        << "EXACT: v = C y, the eigenvalues of C lie in [1, 2]: " << repaid / owed;
}

const Case cases[] = {{Mass::lumped, {1 << 30, true, {}}},
                      {Mass::lumped, {1 << 30, true, {1, 0.1}}},
                      {Mass::lumped, {0, false, {}}},
                      {Mass::corrected, {1 << 30, true, {}}},
                      {Mass::corrected, {0, false, {}}}};
INSTANTIATE_TEST_SUITE_P(LanesAndSpread, BodyDebt, ::testing::ValuesIn(cases));

TEST(BodyDebts, take_a_millionth_a_step_at_most) {
  Bench bench(ringing_discs(Mass::lumped));
  const BodyDebts debts(bench.model);
  debts.settle(bench.state, 0);
  make_faster(bench.state, 0.5);
  const std::vector<Lanes> before = bench.state.reduced_momentum.compliant;
  debts.settle(bench.state, 0);
  double change = 0, reach = 0;  // of a disc as it was meshed vibrations are the stretching
  for (std::size_t i = 0; i < before.size(); ++i) {
    change = std::max(change, std::abs(before[i][0] - bench.state.reduced_momentum.compliant[i][0]));
    reach = std::max(reach, std::abs(bench.state.position.compliant[i][0]));
  }
  EXPECT_NEAR(change, most_settled * 1.5 * 0.3 * reach, 1e-15) << "EXACT: stretched by 0.3 x, half as fast again";
}

TEST(BodyDebts, are_kept_where_energy_has_no_other_way) {
  const auto kept = [](auto&& change) {
    Scene scene = ringing_discs(Mass::lumped);
    change(scene);
    return BodyDebts(build_model(scene)).are_kept();
  };
  EXPECT_TRUE(kept([](Scene&) {}));
  EXPECT_FALSE(kept([](Scene& scene) { scene.materials[0].viscosity = 0.1; }));
  EXPECT_FALSE(kept([](Scene& scene) { scene.materials[0].mass_damping = 0.1; }));
  EXPECT_FALSE(kept([](Scene& scene) { scene.materials[0].law = MaterialLaw::neo_hookean_maxwell; }));
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

struct Debts {
  double largest = 0;  ///< of one body's, J/m
  double lost = 0;     ///< largest loss of kinetic energy, J/m
};

/// In equal steps, by settlements too.
Debts debts_over(const Scene& scene, double dt, double end) {
  Bench bench(scene);
  Verlet verlet(bench.forces, bench.state);
  const BodyDebts debts(bench.model);
  debts.settle(bench.state, dt);
  const double start = kinetic_energy(bench.model, bench.state.reduced_momentum);
  Debts result;
  for (int step = 0; step < std::lround(end / dt); ++step) {
    bench.state.next_dt = dt;
    take_step(verlet, bench.forces, bench.state, 1e9);
    result.lost = std::max(result.lost, start - kinetic_energy(bench.model, bench.state.reduced_momentum));
    for (int b = 0; b < static_cast<int>(bench.model.batches.size()); ++b) {
      const Lanes each = debts.owed(bench.state, b, dt);
      for (int lane = 0; lane < bench.model.batches[b].count; ++lane)
        result.largest = std::max(result.largest, std::abs(each[lane]));
    }
  }
  return result;
}

/// The work of the mean of linear forces is what they store.
TEST(BodyDebts, linear_stresses_owe_nothing) {
  for (const Mass mass : {Mass::lumped, Mass::corrected}) {
    Scene scene = two_discs_meet(MaterialLaw::linear_elastic);
    scene.discretisation.mass = mass;
    const Debts debts = debts_over(scene, 0.02, 6);
    EXPECT_GT(debts.lost, 0.01) << "or they did not meet";
    EXPECT_LT(debts.largest, 1e-13 * debts.lost) << "EXACT: rounding of some hundred steps";
  }
}

/// In smooth motion the work of stresses is that of their mean up to the square of the step.
TEST(BodyDebts, fall_with_the_square_of_the_step) {
  const Scene scene = two_discs_meet(MaterialLaw::neo_hookean);
  std::vector<double> owed;
  for (const double dt : {0.02, 0.01, 0.005}) {
    const Debts debts = debts_over(scene, dt, 4);
    EXPECT_GT(debts.lost, 0.01) << "or they did not meet";
    owed.push_back(debts.largest);
  }
  for (std::size_t i = 0; i + 1 < owed.size(); ++i)
    EXPECT_NEAR(observed_order(owed[i], owed[i + 1]), 2, 0.3) << "RATE: " << owed[i] << ", " << owed[i + 1];
}

TEST(BodyDebts, a_fall_owes_nothing) {
  Scene scene = free_disc(30, 20, moving({0.1, 0.3}));
  scene.gravity = {0.02, -0.2};
  without_error_control(scene, 1);
  const double weight = 0.2 * M_PI, fallen = 0.5 * 0.2 * 25 - 0.3 * 5;
  EXPECT_LT(debts_over(scene, 0.02, 5).largest, 1e-13 * weight * fallen) << "EXACT: rounding of steps";
}

}  // namespace
}  // namespace pliant::dynamics_tests
