// Sliding and rolling on a floor with Coulomb friction, and the energy balance while friction works.
#include <gtest/gtest.h>

#include <numbers>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double g = 9.81;

/// A block of 0.1 m x 0.05 m at the penetration that carries its weight.
Scene sliding_block(double friction, double speed, double safety) {
  constexpr double stiffness = 1e9, density = 2000, height = 0.05;
  Scene scene = on_a_floor(1, 1, 0.01, {0, -g});
  scene.materials[1].density = density;
  scene.shapes = {box_shape("block", 0.1, height, 0.01)};
  const double penetration = density * g * height / stiffness;
  scene.grains = {grains("block", "block", BodyKind::rigid, {{0.3, height / 2 - penetration}}, moving({speed, 0}))};
  scene.contacts = {mohr_coulomb(stiffness, friction)};
  scene.time.safety = safety;
  return scene;
}

struct Stop {
  double time = 0, distance = 0;
};

/// When and where the block's velocity first reaches zero.
Stop run_to_stop(Simulation& simulation, double end) {
  while (simulation.state().time < end) {
    const double before = rigid(simulation.state().reduced_momentum, 0)[0],
                 x = rigid(simulation.state().position, 0)[0];
    const StepReport report = simulation.step(end);
    const double after = rigid(simulation.state().reduced_momentum, 0)[0];
    if (after <= 0) return {simulation.state().time - report.dt * after / (after - before), x - 0.3};
  }
  return {};
}

Stop stop_of(double friction, double speed, double safety) {
  const Model model = build_model(sliding_block(friction, speed, safety));
  Simulation simulation(model);
  return run_to_stop(simulation, 1);
}

/// Friction is mu times the normal force, whose mean is the weight. While the block rocks and hops on its stiffness
/// with frequency w, its vertical momentum is some m g/w, so u errs by mu g/w = 1e-3 of u0: of that order is the
/// distance's error, and five hops the time's. The step adds nothing, because friction acts from the first step of
/// each new contact.
TEST(SlidingBlock, stops_after_u0_over_mu_g) {
  const double friction = 0.3, speed = 1;
  for (const double safety : {0.8, 0.2, 0.05}) {
    const Stop stop = stop_of(friction, speed, safety);
    EXPECT_NEAR(stop.time * friction * g / speed, 1, 5e-3) << "EXACT: u0/(mu g), safety " << safety;
    EXPECT_NEAR(stop.distance * 2 * friction * g / (speed * speed), 1, 1e-3)
        << "EXACT: u0^2/(2 mu g), safety " << safety;
  }
}

/// All kinetic energy goes into friction but what swings on in hopping and in the elastic slip, (mu p)^2/(2 kt) a
/// length.
TEST(SlidingBlock, dissipates_its_kinetic_energy_and_the_books_notice_half_of_it_missing) {
  const Model model = build_model(sliding_block(0.3, 1, 0.1));
  Simulation simulation(model);
  const double start = simulation.energy_balance().energy.kinetic;
  advance(simulation, 0.5);
  Energies energy = simulation.energy_balance().energy;
  EXPECT_NEAR(energy.dissipated, start, 2e-3 * start) << "EXACT";
  EXPECT_LT(energy.kinetic, 1e-3 * start);
  EXPECT_LT(simulation.balance_error(energy), 2e-3) << "EXACT: 1 % is promised";
  energy.dissipated /= 2;
  EXPECT_NEAR(simulation.balance_error(energy), 0.5, 2e-3) << "EXACT: half of the friction work dropped";
}

/// The definition, term by term, from figures that a test can make up.
TEST(BalanceError, is_the_missing_energy_over_the_larger_of_work_and_start) {
  const Model model = build_model(sliding_block(0.3, 1, 0.8));
  Simulation simulation(model);
  const double start = simulation.energy_balance().energy.mechanical();
  const auto error = [&](double gained, double work, double dissipated) {
    Energies energy;
    energy.kinetic = start + gained;
    energy.external_work = work;
    energy.dissipated = dissipated;
    return simulation.balance_error(energy);
  };
  EXPECT_NEAR(error(0, 0, 0), 0, 1e-15) << "EXACT";
  EXPECT_NEAR(error(0.1 * start, 0, 0), 0.1, 1e-14) << "EXACT: over the start, work is smaller";
  EXPECT_NEAR(error(0, 0, 0.2 * start), 0.2, 1e-14) << "EXACT: dissipation out of nothing";
  EXPECT_NEAR(error(3 * start, 4 * start, start), 0, 1e-14) << "EXACT: all accounted for";
  EXPECT_NEAR(error(0, 4 * start, 0), 1, 1e-14) << "EXACT: over the work, which is larger";
  EXPECT_NEAR(error(0, -4 * start, 0), 1, 1e-14) << "EXACT: work of either sign";
}

constexpr double radius = 0.05;

/// A rigid disc of so many sides at the penetration that carries its weight: half a contact width a = sqrt(2 R d),
/// weight = 4/3 kn a d.
Scene disc_on_floor(int sides, double stiffness, double friction, const Vec2& gravity, double speed) {
  Scene scene = on_a_floor(1, 1, 2 * std::numbers::pi * radius / sides, gravity);
  scene.materials[1].density = 2000;
  scene.shapes = {polygonal_disc("disc", 2 * radius, sides)};
  const double weight = 2000 * std::numbers::pi * radius * radius * -gravity.y();
  const double penetration = std::pow(3 * weight / (4 * stiffness * std::sqrt(2 * radius)), 2.0 / 3);
  scene.grains = {grains("disc", "disc", BodyKind::rigid, {{0.3, radius - penetration}}, moving({speed, 0}))};
  scene.contacts = {mohr_coulomb(stiffness, friction)};
  scene.time.tolerance = 1e-3;
  return scene;
}

struct Rolling {
  double meeting_time = 0, speed = 0, penetration = 0;
};

/// Starts with 1 m/s and no spin; the speed is a mean over what would be 8 cm of rolling.
Rolling slide_and_roll(double stiffness, double friction) {
  Scene scene = disc_on_floor(1000, stiffness, friction, {0, -g}, 1);
  scene.time.safety = 0.2;
  const Model model = build_model(scene);
  Simulation simulation(model);
  Rolling result;
  result.penetration = radius - rigid(simulation.state().position, 0)[1];
  while (result.meeting_time == 0 && simulation.state().time < 1) {
    const StepReport report = simulation.step(1);
    const Eigen::Vector3d v = rigid(simulation.state().reduced_momentum, 0);
    if (-v[2] * radius >= v[0]) result.meeting_time = simulation.state().time - report.dt / 2;
  }
  advance(simulation, 0.25);
  const double start = rigid(simulation.state().position, 0)[0];
  advance(simulation, 0.37);
  result.speed = (rigid(simulation.state().position, 0)[0] - start) / 0.12;
  return result;
}

/// u = u0 - mu g t and w R = 2 mu g t meet at t = u0/(3 mu g), u = 2 u0/3. On a floor that gives way by d friction
/// acts between R - d and R below the centre: u = u0/(1 + R^2/(2 r^2)) errs by 2 d/(3 R) at most, and the time by
/// d/R.
TEST(RollingDisc, sliding_turns_to_rolling) {
  const double friction = 0.2;
  const Rolling soft = slide_and_roll(1e8, friction), stiff = slide_and_roll(1e9, friction);
  for (const Rolling& rolling : {soft, stiff}) {
    const double give = rolling.penetration / radius;
    EXPECT_NEAR(rolling.speed * 3 / 2, 1, 2.0 / 3 * give) << "EXACT: 2 u0/3";
    EXPECT_NEAR(rolling.meeting_time * 3 * friction * g, 1, give) << "EXACT: u0/(3 mu g)";
  }
  const double order = observed_order(soft.speed * 3 / 2 - 1, stiff.speed * 3 / 2 - 1, 10);
  EXPECT_NEAR(order, 2.0 / 3, 0.1) << "RATE: d falls as stiffness^(-2/3)";
}

struct Descent {
  double way = 0, spin = 0;  ///< over 0.3 s from rest: distance, and angular velocity x R at the end
  double penetration = 0;
};

Descent roll_down(double degrees, double friction, int sides) {
  const double slope = degrees * std::numbers::pi / 180;
  const Model model = build_model(disc_on_floor(sides, 1e9, friction, {g * std::sin(slope), -g * std::cos(slope)}, 0));
  Simulation simulation(model);
  const double penetration = radius - rigid(simulation.state().position, 0)[1];
  advance(simulation, 0.3);
  return {rigid(simulation.state().position, 0)[0] - 0.3, -rigid(simulation.state().reduced_momentum, 0)[2] * radius,
          penetration};
}

/// tan(theta) <= 3 mu: rolls with a = 2/3 g sin(theta). The lever errs by d/R as above. Nodes that pass through the
/// half width A of contact gather the elastic slip that friction needs: creep (tan(theta)/3) (2/3) d/A of the spin.
TEST(Incline, disc_rolls_with_two_thirds_of_the_slope) {
  for (const auto& [degrees, friction] : {std::pair(10.0, 0.2), std::pair(40.0, 0.5)}) {
    const Descent descent = roll_down(degrees, friction, 1000);
    const double slope = degrees * std::numbers::pi / 180, a = 2.0 / 3 * g * std::sin(slope);
    const double half_width = std::sqrt(2 * radius * descent.penetration);
    const double tolerance =
        descent.penetration / radius + std::tan(slope) / 3 * 2 / 3 * descent.penetration / half_width;
    EXPECT_LT(tolerance, 6e-3);
    EXPECT_NEAR(descent.way / (0.5 * a * 0.09), 1, tolerance) << "EXACT, " << degrees << " degrees";
    EXPECT_NEAR(descent.spin / (a * 0.3), 1, tolerance) << "EXACT";
  }
}

/// Steeper it slides: a = g (sin - mu cos), R dw/dt = 2 mu g cos. Friction acts in full after the elastic slip mu d,
/// so after sqrt(2 mu d / (g sin)); up to then it may be missing.
TEST(Incline, disc_slides_where_it_is_too_steep) {
  const double friction = 0.2, slope = 40 * std::numbers::pi / 180;
  const Descent descent = roll_down(40, friction, 1000);
  const double a = g * (std::sin(slope) - friction * std::cos(slope)), spin = 2 * friction * g * std::cos(slope);
  const double late = std::sqrt(2 * friction * descent.penetration / (g * std::sin(slope))) / 0.3;
  EXPECT_LT(late, 7e-3);
  EXPECT_NEAR(descent.way / (0.5 * a * 0.09), 1, late) << "EXACT";
  EXPECT_NEAR(descent.spin / (spin * 0.3), 1, late) << "EXACT";
}

/// Facets lift the centre by R (1 - cos(pi/n)), order two; their rattle dies faster.
TEST(Incline, converges_with_the_number_of_sides) {
  const double limit = roll_down(10, 0.2, 1000).way;
  const double coarse = roll_down(10, 0.2, 60).way - limit, middle = roll_down(10, 0.2, 170).way - limit,
               fine = roll_down(10, 0.2, 340).way - limit;
  EXPECT_LT(std::abs(middle), std::abs(coarse));
  EXPECT_LT(std::abs(fine), std::abs(middle));
  const double order = observed_order(coarse, fine, 340.0 / 60);
  EXPECT_GT(order, 1.5) << "RATE";
  EXPECT_LT(order, 3.5) << "RATE";
}

}  // namespace
}  // namespace pliant::dynamics_tests
