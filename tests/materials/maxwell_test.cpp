// Neo-Hookean solid with a Maxwell branch: closed forms of a point, its energy balance, and bodies in motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies/body_view.hpp"
#include "materials/neo_hookean_maxwell.hpp"
#include "results/point_states.hpp"
#include "setup/build_model.hpp"
#include "support/material_discs.hpp"
#include "support/material_points.hpp"

namespace pliant::dynamics_tests {
namespace {

using MaxwellRecord = NeoHookeanMaxwell<double>::Record;
constexpr double branch = 1.3, relaxation_time = 0.4;
constexpr MaxwellRecord at_rest{0, 0, 0, 1, 0, 1};
/// Of some fifty operations on numbers of order one.
constexpr double rounding_of_relaxation = 2e-14;

template <class T = double>
NeoHookeanMaxwell<T> maxwell_law() {
  return {mu, lambda, branch, relaxation_time};
}

/// Some state that a point may have come to.
MaxwellRecord random_maxwell_record(testing::Random& random) {
  MaxwellRecord record = at_rest;
  for (int i = 0; i < 3; ++i) {
    MaxwellRecord next;
    maxwell_law().over(random.uniform(0.1, 0.4)).respond(random_deformation(random), record, next);
    record = next;
  }
  return record;
}

// EXACT: at once, before anything relaxes, P = dpsi/dF, by complex step.
TEST(NeoHookeanMaxwell, stress_is_the_derivative_of_the_energy) {
  testing::Random random(1);
  for (int sample = 0; sample < 50; ++sample) {
    const MaxwellRecord old = random_maxwell_record(random);
    const Tensor<double> F = random_deformation(random);
    MaxwellRecord now;
    const Tensor<double> P = maxwell_law().respond(F, old, now).P;
    const double entries[4] = {P.xx, P.xy, P.yx, P.yy};
    for (int entry = 0; entry < 4; ++entry) {
      Complex f[4] = {F.xx, F.xy, F.yx, F.yy};
      f[entry] += Complex(0, tiny);
      NeoHookeanMaxwell<Complex>::Record before, after;
      std::copy(old.begin(), old.end(), before.begin());
      const Tensor<Complex> stepped{f[0], f[1], f[2], f[3]};
      maxwell_law<Complex>().respond(stepped, before, after);
      const double slope = maxwell_law<Complex>().energy(stepped, after).imag() / tiny;
      EXPECT_NEAR(entries[entry], slope, 100 * rounding_of_relaxation);
    }
  }
}

// EXACT: a turn of the body turns the stress and nothing else; at rest there is none; energy and power stay above 0.
TEST(NeoHookeanMaxwell, is_objective_and_dissipates) {
  testing::Random random(2);
  for (int sample = 0; sample < 50; ++sample) {
    const MaxwellRecord old = random_maxwell_record(random);
    const Tensor<double> F = random_deformation(random);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    MaxwellRecord now, now_turned;
    const auto straight = maxwell_law().over(0.1).respond(F, old, now);
    const auto round = maxwell_law().over(0.1).respond(turned(F, angle), old, now_turned);
    expect_near(round.P, turned(straight.P, angle), 100 * rounding_of_relaxation);
    EXPECT_NEAR(round.power, straight.power, 100 * rounding_of_relaxation);
    EXPECT_GT(straight.power, 0);
    EXPECT_GT(maxwell_law().energy(F, now), 0);
    const auto none = maxwell_law().over(0.1).respond(turned({1, 0, 0, 1}, angle), at_rest, now);
    expect_near(none.P, {0, 0, 0, 0}, rounding_of_relaxation);
    EXPECT_NEAR(none.power, 0, rounding_of_relaxation);
  }
}

// EXACT: held at any strain, the branch's stress falls as exp(-t / relaxation time), whatever the steps.
TEST(NeoHookeanMaxwell, relaxes_exponentially) {
  testing::Random random(3);
  for (const int steps : {1, 7}) {
    const Tensor<double> F = random_deformation(random);
    MaxwellRecord record;
    const Tensor<double> start = maxwell_law().respond(F, at_rest, record).P;
    const Tensor<double> relaxed = NeoHookean<double>{mu, lambda}.respond(F).P;
    constexpr double time = 0.9;
    Tensor<double> P{};
    for (int i = 0; i < steps; ++i) {
      MaxwellRecord next;
      P = maxwell_law().over(time / steps).respond(F, record, next).P;
      record = next;
    }
    const double left = std::exp(-time / relaxation_time);
    const auto expected = [&](double at_first, double at_last) { return at_last + left * (at_first - at_last); };
    expect_near(P,
                {expected(start.xx, relaxed.xx), expected(start.xy, relaxed.xy), expected(start.yx, relaxed.yx),
                 expected(start.yy, relaxed.yy)},
                10 * rounding_of_relaxation);
    EXPECT_GT(std::abs(start.xy - relaxed.xy), 0.01);
  }
}

/// Shear strain after `time` under a small shear stress that is there from the start, over the stress.
double creep(double time, int steps) {
  constexpr double stress = 1e-7;
  MaxwellRecord record = at_rest, now;
  double shear = stress / (mu + branch);  // at once
  maxwell_law().respond({1, shear, 0, 1}, record, now);
  record = now;
  for (int i = 0; i < steps; ++i) {
    const auto stress_at = [&](double g) {
      return maxwell_law().over(time / steps).respond({1, g, 0, 1}, record, now).P.xy;
    };
    for (int k = 0; k < 3; ++k) {  // all but straight: secants
      const double slope = (stress_at(shear + 1e-8) - stress_at(shear)) / 1e-8;
      shear += (stress - stress_at(shear)) / slope;
    }
    stress_at(shear);
    record = now;
  }
  return shear / stress;
}

// RATE: creep of the standard linear solid, 1/mu - (1/mu - 1/(mu + m)) exp(-t mu / (mu + m) / relaxation time), of
// second order in the step.
TEST(NeoHookeanMaxwell, creeps_as_a_standard_linear_solid) {
  constexpr double time = 0.7;
  const double rate = mu / (mu + branch) / relaxation_time;
  const double expected = 1 / mu - (1 / mu - 1 / (mu + branch)) * std::exp(-time * rate);
  double errors[2];
  for (int i = 0; i < 2; ++i) errors[i] = std::abs(creep(time, 5 << i) - expected);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.4) << errors[0] << " " << errors[1];
  EXPECT_LT(errors[1], 1e-3 * expected);
}

Tensor<double> loop(double t) {
  return {1.1 + 0.3 * std::sin(t), 0.25 * std::sin(2 * t), -0.15 * std::sin(t), 0.95 + 0.2 * std::sin(3 * t)};
}
Tensor<double> loop_rate(double t) {
  return {0.3 * std::cos(t), 0.5 * std::cos(2 * t), -0.15 * std::cos(t), 0.6 * std::cos(3 * t)};
}

// RATE: along a way at large strains, what the stress does is stored or dissipated but for the second order of steps.
TEST(NeoHookeanMaxwell, work_is_stored_or_dissipated) {
  double errors[2];
  for (int i = 0; i < 2; ++i) {
    const int steps = 200 << i;
    const double dt = 2.0 / steps;
    const auto rate_of_work = [](double t, const Tensor<double>& P) {
      const Tensor<double> rate = loop_rate(t);
      return P.xx * rate.xx + P.xy * rate.xy + P.yx * rate.yx + P.yy * rate.yy;
    };
    MaxwellRecord record;
    const auto at_start = maxwell_law().respond(loop(0), at_rest, record);
    const double start = maxwell_law().energy(loop(0), record);
    double power = at_start.power, doing = rate_of_work(0, at_start.P), dissipated = 0, work = 0;
    for (int k = 1; k <= steps; ++k) {
      MaxwellRecord next;
      const auto response = maxwell_law().over(dt).respond(loop(k * dt), record, next);
      dissipated += 0.5 * dt * (power + response.power);
      work += 0.5 * dt * (doing + rate_of_work(k * dt, response.P));
      power = response.power, doing = rate_of_work(k * dt, response.P);
      record = next;
    }
    EXPECT_GT(dissipated, 0.05);
    errors[i] = std::abs(work - dissipated - maxwell_law().energy(loop(2), record) + start);
  }
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.2) << errors[0] << " " << errors[1];
  EXPECT_LT(errors[1], 1e-4);
}

Material viscoelastic(double modulus = branch, double time = relaxation_time) {
  Material material = elastic();
  material.law = MaterialLaw::neo_hookean_maxwell;
  material.branch_modulus = modulus, material.relaxation_time = time;
  return material;
}

// EXACT: of bodies in lanes and of nodewise ones the same forces, memories and stresses.
TEST(NeoHookeanMaxwell, layouts_agree) {
  BuildOptions nodewise, lanes;
  nodewise.least_sparse_nodes = 0, lanes.least_sparse_nodes = 1 << 30;
  nodewise.unite_topologies = lanes.unite_topologies = false;
  const DeformedDisc a(viscoelastic(), 4, nodewise), b(viscoelastic(), 4, lanes);
  ASSERT_NE(a.model.batches[0].layout, b.model.batches[0].layout);
  const BodyView one(a.model, a.model.bodies[0], a.force), other(b.model, b.model.bodies[0], b.force);
  double largest_force = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.model.shape_of(a.model.bodies[0]).nodes()); ++i) {
    EXPECT_LT((one[i] - other[i]).norm(), 1e-13);
    largest_force = std::max(largest_force, one[i].norm());
  }
  EXPECT_GT(largest_force, 0.01);
  const auto states = [](const DeformedDisc& d) {
    return point_states(d.model, d.model.bodies[0], d.position, d.memory);
  };
  const auto s = states(a), t = states(b);
  for (std::size_t g = 0; g < s.size(); ++g) {
    EXPECT_NEAR(s[g].stress.xx, t[g].stress.xx, 1e-12);
    EXPECT_NEAR(s[g].stress.xy, t[g].stress.xy, 1e-12);
    EXPECT_NEAR(s[g].energy, t[g].energy, 1e-12);
  }
}

// RATE: the energy balance of a disc that swings and comes to rest close, at second order in the step with Verlet once
// steps are short for all modes, at first with step doubling; most of its energy is dissipated.
TEST(NeoHookeanMaxwell, books_of_a_disc_close) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::step_doubling}) {
    double errors[2];
    for (int i = 0; i < 2; ++i) {
      Scene scene = oscillating_disc(viscoelastic(), integrator);
      scene.time.safety = 0.1 / (1 << i);
      scene.time.target = 1e-6 / (1 << 2 * i);
      const Model model = build_model(scene);
      Simulation simulation(model);
      while (simulation.state().time < 3) simulation.step(3);
      const EnergyBalance audit = simulation.energy_balance();
      EXPECT_GT(audit.energy.dissipated, 5 * audit.energy.mechanical());
      EXPECT_LT(audit.momentum_error, 1e-12);
      errors[i] = simulation.balance_error(audit.energy);
    }
    const double order = integrator == Integrator::verlet ? 2 : 1;
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, 0.3) << errors[0] << " " << errors[1];
  }
}

// EXACT: a branch that hardly relaxes stiffens at once, and the step's bound counts it: steps are shorter by the root
// of the modulus, sqrt(31) at most. Within the limit of stability Verlet keeps E - dt^2/8 a.M a of small vibrations, so
// that E swings by at most (w dt)^2/4 <= safety^2 of itself; steps of the soft disc make it grow without end.
TEST(NeoHookeanMaxwell, step_bound_counts_the_branch) {
  Scene scene = oscillating_disc(viscoelastic(), Integrator::verlet);
  scene.materials[0] = viscoelastic(30, 1e6);
  const Model stiff = build_model(scene);
  Simulation simulation(stiff);
  scene.materials[0] = elastic();
  const Model soft = build_model(scene);
  EXPECT_LT(simulation.largest_dt(), 0.5 * Simulation(soft).largest_dt());
  while (simulation.state().time < 1) simulation.step(1);
  EXPECT_LT(simulation.balance_error(simulation.energy_balance().energy), scene.time.safety * scene.time.safety);
}

}  // namespace
}  // namespace pliant::dynamics_tests
