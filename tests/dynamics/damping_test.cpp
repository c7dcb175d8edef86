// Kelvin-Voigt and mass-proportional damping (docs/method.md 3): forces, power, decay, energy balance and the time step
// that is stable.
#include "bodies/damping_forces.hpp"
#include "bodies/internal_forces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "core/errors.hpp"
#include "dynamics/time_step_bound.hpp"
#include "dynamics/true_spectrum.hpp"
#include "setup/build_model.hpp"
#include "support/random.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

Scene damped_disc(int nodes, double viscosity, double mass_damping, double poisson = 0.4,
                  const InitialVelocity& velocity = {}) {
  Scene scene = free_disc(nodes, 1e9, velocity);
  Material& soft = scene.materials[0];
  soft.viscosity = viscosity;
  soft.mass_damping = mass_damping;
  soft.poisson = poisson;
  soft.young = 2 * (1 + poisson);  // mu = 1
  return scene;
}

/// Moves body 0 to F X and gives it the velocities L x.
void set_motion(Bench& bench, const Eigen::Matrix2d& F, const Eigen::Matrix2d& L) {
  const Body& body = bench.model.bodies[0];
  const Batch& batch = bench.model.batches[body.batch];
  for (int i = 0; i < bench.model.shape_of(batch).nodes(); ++i) {
    const std::size_t at = batch.offset + 2 * static_cast<std::size_t>(i);
    const Vec2 x = F * node_value(bench.model, body, bench.state.position, i), v = L * x;
    for (std::size_t c = 0; c < 2; ++c) {
      bench.state.position.compliant[at + c][body.lane] = x[static_cast<Eigen::Index>(c)];
      bench.state.reduced_momentum.compliant[at + c][body.lane] = v[static_cast<Eigen::Index>(c)];
    }
  }
}

struct Viscous {
  std::vector<Lanes> force;
  double power = 0;
};

Viscous viscous_forces(const Bench& bench) {
  Viscous result{std::vector<Lanes>(bench.model.compliant_size, Lanes{}), 0};
  const BatchMotion motion{.position = bench.state.position.compliant.data(),
                           .velocity = bench.state.reduced_momentum.compliant.data(),
                           .elastic = false};
  result.power = add_internal_forces(bench.model, bench.model.batches[0], motion, result.force.data()).power[0];
  return result;
}

const Eigen::Matrix2d large_strain = matrix(1.3, 0.3, -0.1, 0.8);

TEST(KelvinVoigt, does_not_resist_rigid_motion) {
  Bench bench(damped_disc(60, 0.7, 0));
  set_motion(bench, large_strain, matrix(0, -1.7, 1.7, 0));
  const Viscous spin = viscous_forces(bench);
  for (const Lanes& f : spin.force)
    EXPECT_NEAR(f[0], 0, 1e-13) << "EXACT: rounding of some twenty products of order one";
  EXPECT_NEAR(spin.power, 0, 1e-25) << "EXACT: square of rounding";
}

/// S = 2 eta sym(F^T L F) is the same everywhere: power = area 2 eta S:S, and the forces do minus that.
TEST(KelvinVoigt, power_is_that_of_its_forces_and_of_a_homogeneous_flow) {
  Bench bench(damped_disc(60, 0.7, 0));
  const Eigen::Matrix2d L = matrix(0.3, -1.1, 0.4, 0.2);
  set_motion(bench, large_strain, L);
  const Viscous flow = viscous_forces(bench);
  double work = 0;
  for (std::size_t i = 0; i < flow.force.size(); ++i)
    work += flow.force[i][0] * bench.state.reduced_momentum.compliant[i][0];
  const Eigen::Matrix2d rate = large_strain.transpose() * L * large_strain, strain = 0.5 * (rate + rate.transpose());
  EXPECT_NEAR(flow.power, 2 * 0.7 * bench.model.bodies[0].area * strain.squaredNorm(), 1e-12) << "EXACT";
  EXPECT_NEAR(work, -flow.power, 1e-12) << "EXACT";
}

/// P = F S makes P F^T symmetric, and gradients sum to nothing.
TEST(KelvinVoigt, keeps_momentum_and_angular_momentum) {
  Bench bench(damped_disc(60, 0.7, 0));
  testing::Random random(3);
  for (Lanes& v : bench.state.reduced_momentum.compliant) v = broadcast(random.uniform(-1, 1));
  set_motion(bench, large_strain, Eigen::Matrix2d::Zero());
  for (Lanes& v : bench.state.reduced_momentum.compliant) v = broadcast(random.uniform(-1, 1));
  const Viscous noise = viscous_forces(bench);
  double x = 0, y = 0, moment = 0, magnitude = 0;
  for (std::size_t i = 0; i < noise.force.size(); i += 2) {
    const double fx = noise.force[i][0], fy = noise.force[i + 1][0];
    x += fx, y += fy, magnitude += std::hypot(fx, fy);
    moment += bench.state.position.compliant[i][0] * fy - bench.state.position.compliant[i + 1][0] * fx;
  }
  EXPECT_GT(magnitude, 1);
  EXPECT_LT(std::max({std::abs(x), std::abs(y), std::abs(moment)}), 1e-13 * magnitude) << "EXACT: rounding";
}

/// Extremes of the difference of second moments in x and y while a disc rings in its oval mode: the other modes that
/// an affine start excites are of higher frequency.
struct Ring {
  std::vector<double> time, size;
};

Ring ring(Scene scene, double duration) {
  without_error_control(scene, 0.1);
  const Model model = build_model(scene);
  Simulation simulation(model);
  const std::vector<double> masses = node_masses(model, model.bodies[0]);
  const auto difference = [&] {
    double total = 0;
    for (int i = 0; i < static_cast<int>(masses.size()); ++i) {
      const Vec2 x = node_value(model, model.bodies[0], simulation.state().position, i);
      total += masses[i] * (x.x() * x.x() - x.y() * x.y());
    }
    return total;
  };
  const double start = difference();  // the mesh is not quite the same in x and y
  Ring result;
  double before = 0, here = 0, time = 0;
  while (simulation.state().time < duration) {
    const StepReport report = simulation.step(duration);
    const double next = difference() - start;
    if ((here - before) * (next - here) < 0) {  // the vertex of the parabola through three equal steps
      const double bend = before - 2 * here + next, slope = 0.5 * (next - before);
      result.time.push_back(time - report.dt * slope / bend);
      result.size.push_back(std::abs(here - slope * slope / (2 * bend)));
    }
    before = here, here = next, time = simulation.state().time;
  }
  return result;
}

/// With lambda = 0 all stress is 2 mu e, so viscosity makes 2 z w = viscosity/mu w^2 of every mode: amplitudes fall
/// at the rate r = viscosity/(2 mu) w^2, and w^2 = r^2 + (pi / half period)^2. From the fourth extreme on the higher
/// modes of the start have decayed.
TEST(KelvinVoigt, oval_mode_of_a_disc_decays_at_its_rate) {
  for (const double viscosity : {0.15, 0.25}) {
    const Ring damped = ring(damped_disc(60, viscosity, 0, 0, stretching(1e-3)), 14);
    ASSERT_GE(damped.size.size(), 8u);
    const double half_period = (damped.time[7] - damped.time[3]) / 4;
    const double rate = std::log(damped.size[3] / damped.size[7]) / 4 / half_period;
    const double square = rate * rate + std::pow(std::numbers::pi / half_period, 2);
    EXPECT_NEAR(rate / (viscosity / 2 * square), 1, 0.01)
        << "EXACT: but for what is left of higher modes; viscosity " << viscosity;
  }
}

/// All modes decay by exp(- rate t/2). Their extremes come earlier by rate/(2 w^2), in which the decay is (rate/2w)^2,
/// 2e-4 of the oval mode, w = 1.85; their frequencies fall by half of that, 2e-3 rad until then, by which higher modes
/// of the start are out of step.
TEST(MassDamping, all_modes_of_a_disc_decay_at_half_its_rate) {
  const double rate = 0.05;
  const Ring free = ring(damped_disc(60, 0, 0, 0.4, stretching(1e-3)), 9);
  const Ring damped = ring(damped_disc(60, 0, rate, 0.4, stretching(1e-3)), 9);
  ASSERT_GE(free.size.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k)
    EXPECT_NEAR(damped.size[k] / free.size[k] / std::exp(-rate * free.time[k] / 2), 1, 5e-4) << "EXACT: as above";
}

Scene sliding_bodies(double mass_damping) {
  Scene scene = empty_scene(3);
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("soft", "disc", BodyKind::compliant, {{0, 0}}, moving({0.5, 0.7})),
                  grains("hard", "disc", BodyKind::rigid, {{10, 0}}, moving({0.5, 0.7}, 1.5))};
  for (Material& material : scene.materials) material.mass_damping = mass_damping;
  return scene;
}

/// Exactly by `verlet`. Step doubling, semi-implicit Euler, is of the first order: v falls by 1 - rate h in each half
/// step h.
TEST(MassDamping, speed_falls_exponentially) {
  const double rate = 0.4;
  const auto error = [&](Integrator integrator, double target) {
    Scene scene = sliding_bodies(rate);
    scene.time.integrator = integrator;
    scene.time.target = target;
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 3);
    const Eigen::Vector3d v = rigid(simulation.state().reduced_momentum, 0);
    const Vec2 soft = mass_mean(model, model.bodies[0], simulation.state().reduced_momentum);
    EXPECT_NEAR(v[0] / 0.5, v[2] / 1.5, 1e-13) << "EXACT: all degrees of freedom alike";
    EXPECT_NEAR(soft.x(), v[0], 1e-12) << "EXACT: both kinds of body alike";
    EXPECT_NEAR(soft.y(), v[1], 1e-12) << "EXACT";
    return std::pair(std::abs(v[0] / 0.5 - std::exp(-3 * rate)), 3.0 / static_cast<double>(simulation.state().steps));
  };
  EXPECT_LT(error(Integrator::verlet, 0).first, 1e-12) << "EXACT";
  const auto [coarse, long_step] = error(Integrator::step_doubling, 1e-4);
  const auto [fine, short_step] = error(Integrator::step_doubling, 1e-6);
  EXPECT_NEAR(observed_order(coarse, fine, long_step / short_step), 1, 0.3) << "RATE";
}

TEST(EnergyBalance, close_for_damped_bodies_as_the_step_falls) {
  for (const auto& [viscosity, mass_damping] : {std::pair(0.05, 0.0), std::pair(0.0, 0.4)}) {
    const auto imbalance = [&](double safety) {
      Scene scene = damped_disc(60, viscosity, mass_damping, 0.4, stretching(0.3));
      scene.time.end = 6;
      without_error_control(scene, safety);
      const Model model = build_model(scene);
      Simulation simulation(model);
      advance(simulation, 6);
      const Energies energy = simulation.energy_balance().energy;
      EXPECT_GT(energy.dissipated, 5 * energy.mechanical()) << "nearly all is gone";
      return simulation.balance_error(energy);
    };
    EXPECT_LT(imbalance(0.8), 0.01) << "EXACT: the promise of 1 %";
    EXPECT_NEAR(observed_order(imbalance(0.1), imbalance(0.025), 4), 2, 0.3) << "RATE";
  }
}

/// The largest step of dense matrices: w^2 and the rate of all modes.
double true_largest_dt(Bench& bench) {
  const std::size_t size = bench.model.compliant_size;
  Eigen::MatrixXd rates(size, size);
  const CompliantShape& shape = bench.model.shapes[0];
  for (std::size_t j = 0; j < size; ++j) {
    for (Lanes& v : bench.state.reduced_momentum.compliant) v = Lanes{};
    bench.state.reduced_momentum.compliant[j] = broadcast(1);
    const Viscous unit = viscous_forces(bench);
    for (std::size_t i = 0; i < size; ++i) rates(i, j) = -unit.force[i][0] * shape.inverse_mass_at_unit_density[i / 2];
  }
  for (Lanes& v : bench.state.reduced_momentum.compliant) v = Lanes{};
  const double c = Eigen::EigenSolver<Eigen::MatrixXd>(rates, false).eigenvalues().real().maxCoeff();
  const double w2 = largest_square_frequency(bench);
  const double z = c / (2 * std::sqrt(w2));
  return 2 / std::sqrt(w2) * (std::sqrt(1 + 4 * z * z) - 2 * z);
}

TEST(Bound, follows_the_rates_of_a_deformed_viscous_disc) {
  for (const double viscosity : {0.01, 0.3}) {
    Bench bench(damped_disc(40, viscosity, 0));
    set_motion(bench, matrix(1.4, 0, 0, 0.75), Eigen::Matrix2d::Zero());
    bench.evaluate_here();
    TimeStepBound bound(bench.model, bench.forces.contact().laws());
    bound.update_internal(bench.state.position, bench.state.memory);
    bound.update_contact(bench.forces.contact(), bench.forces.bonds());
    const double dt = bound.largest_dt() / bench.model.scene.time.safety, truth = true_largest_dt(bench);
    EXPECT_LE(dt, truth) << "INDEPENDENT: dense eigenvalues";
    EXPECT_GE(dt, truth / 1.05) << "INDEPENDENT: the margin of 1.05";
  }
}

/// Energy left of a disc that starts with noise, after 2000 steps of a given share of the bound.
double energy_after(double viscosity, double mass_damping, double safety, Mass mass = Mass::lumped) {
  Scene scene = damped_disc(40, viscosity, mass_damping, 0.4, stretching(1e-6));
  scene.discretisation.mass = mass;
  without_error_control(scene, safety);
  const Model model = build_model(scene);
  Simulation simulation(model);
  try {
    for (int i = 0; i < 2000; ++i) simulation.step(1e9);
  } catch (const PhysicsError&) {
    return std::numeric_limits<double>::infinity();  // turned inside out
  }
  return simulation.energy_balance().energy.mechanical();
}

TEST(Bound, is_where_damped_motion_becomes_unstable) {
  for (const auto& [viscosity, mass_damping] : {std::pair(0.02, 0.0), std::pair(1.0, 0.0), std::pair(0.0, 10.0)}) {
    EXPECT_LT(energy_after(viscosity, mass_damping, 1), 1e-12) << "EXACT: stable, " << viscosity;
    EXPECT_LT(energy_after(viscosity, mass_damping, 1, Mass::corrected), 1e-12) << "EXACT: stable, " << viscosity;
    EXPECT_GT(energy_after(viscosity, mass_damping, 1.15), 1e-3)
        << "EXACT: 15 % above it grows until elements turn inside out, " << viscosity;
  }
}

/// Bodies of one shape share a batch whatever their viscosity: those without have none.
TEST(Bound, mixed_batches_have_the_bounds_of_their_bodies) {
  const auto largest_dt = [](double first, double second) {
    Scene scene = damped_disc(40, first, 0, 0.4, stretching(1e-6));
    scene.materials.push_back(scene.materials[0]);
    scene.materials.back().name = "other";
    scene.materials.back().viscosity = second;
    scene.grains.push_back(scene.grains[0]);
    scene.grains.back().name = "other";
    scene.grains.back().species[0].material = "other";
    scene.grains.back().packing.positions = {{5, 0}};
    const Model model = build_model(scene);
    return Simulation(model).largest_dt();
  };
  const double viscous = largest_dt(1, 1);
  EXPECT_NEAR(largest_dt(1, 0) / viscous, 1, 0.05) << "EXACT but for power iterations, whose margin is 5 %";
  EXPECT_NEAR(largest_dt(0, 1) / viscous, 1, 0.05) << "EXACT likewise";
  EXPECT_GT(largest_dt(0, 0), 2 * viscous);
}

}  // namespace
}  // namespace pliant::dynamics_tests
