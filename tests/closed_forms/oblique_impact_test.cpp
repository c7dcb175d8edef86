// Restitution with friction: a rigid body hits a floor at an angle. What the normal force does in all, friction does in
// the share mu while it slides; while it sticks, spring and dashpot are those of one degree of freedom each
// (docs/method.md 4).
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "contact/law_table.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double floor_stiffness = 100;  ///< kn
constexpr double fall = 0.01;            ///< speed of the fall

ContactRule rough_and_bouncing(double friction, double restitution) {
  ContactRule rule = mohr_coulomb(floor_stiffness, friction);
  rule.restitution = restitution;
  return rule;
}

/// Velocities just before and after an impact: x, y, spin.
struct Impact {
  Eigen::Vector3d before, after;
  double longest_step = 0;
  Eigen::Vector3d change() const { return after - before; }
};

/// From above the floor until nothing touches any more. A contact without force may still overlap: the body leaves with
/// its speed.
Impact impact(const Scene& scene, double level) {
  const Model model = build_model(scene);
  Simulation simulation(model);
  Impact result{rigid(simulation.state().reduced_momentum, 0), {}};
  bool touched = false;
  for (;;) {
    const StepReport report = simulation.step(1e9);
    const double gap = rigid(simulation.state().position, 0)[1] - level;
    if (gap < 0) result.longest_step = std::max(result.longest_step, report.dt);
    touched |= gap < 0;
    if (touched && gap > 0) break;
  }
  result.after = rigid(simulation.state().reduced_momentum, 0);
  return result;
}

/// A block of 2 x 1 that cannot turn, its corners between nodes of the floor all through the impact: mass 2 on a face
/// of 2, so w^2 = kn.
Scene thrown_block(const ContactRule& rule, double slide, double safety) {
  Scene scene = on_a_floor(1e9, 8, 0.25, {0, 0});
  scene.shapes = {box_shape("block", 2, 1, 0.25)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{4.04, 0.5 + 1e-4}}, moving({slide, -fall}))};
  BoundaryCondition upright;
  upright.grains = "block";
  upright.angle = {AxisCondition::Mode::velocity, constant(0)};
  scene.boundary = {upright};
  scene.contacts = {rule};
  scene.contact.energy_consistent = false;              // forces of the correction after contact have no friction
  scene.contact.quadrature = ContactQuadrature::nodes;  // over segments flanks that are in the floor touch it too
  without_error_control(scene, safety);
  return scene;
}

/// EXACT: a block that slides all through loses mu (1 + e) v of its speed. One step slides it further than the slip mu
/// p/kt that friction takes to build up, so that nothing is missing.
TEST(ObliqueImpact, a_sliding_block_loses_mu_times_the_normal_impulse) {
  constexpr double friction = 0.3, slide = 0.5;
  for (const double e : {0.3, 0.6, 1.0}) {
    const Impact hit = impact(thrown_block(rough_and_bouncing(friction, e), slide, 0.02), 0.5);
    EXPECT_NEAR(-hit.change()[0] / (friction * hit.change()[1]), 1, 1e-12) << "rounding of sums, e " << e;
    EXPECT_NEAR(hit.change()[1] / fall, 1 + e, 0.005) << "RATE: with the step, e " << e;
  }
}

/// EXACT: a block that sticks swings sideways with w_t = sqrt(kt/kn) w until the normal force is over, after 2 acos(z)
/// / (w sqrt(1 - z^2)). The shear that is left then does nothing more, as its limit is gone.
TEST(ObliqueImpact, a_sticking_block_swings_sideways_while_it_is_pressed) {
  constexpr double slide = 0.003;
  for (const double e : {0.3, 0.6})
    for (const double ratio : {0.3, 0.8}) {
      ContactRule rule = rough_and_bouncing(1e5, e);
      rule.shear_stiffness = ratio * floor_stiffness;
      const Impact hit = impact(thrown_block(rule, slide, 0.004), 0.5);
      const double z = damping_ratio(e, false), pressed = 2 * std::acos(z) / std::sqrt(1 - z * z);
      // Touch begins and ends within a step, and the dashpot sees half a step less.
      const double tolerance = 3 * std::sqrt(floor_stiffness) * hit.longest_step;
      EXPECT_LT(tolerance, 0.02);
      EXPECT_NEAR(hit.after[0] / slide, std::cos(std::sqrt(ratio) * pressed), tolerance) << "e " << e << " " << ratio;
    }
}

/// A disc of so many sides that falls between two nodes of the floor: only its own nodes touch, with upright normals.
Scene thrown_disc(const ContactRule& rule, double slide, double spin) {
  Scene scene = on_a_floor(1e9, 8, 0.5, {0, 0});
  scene.shapes = {polygonal_disc("disc", 2, 1000)};
  scene.grains = {grains("disc", "disc", BodyKind::rigid, {{4.2, 1.0 + 1e-4}}, moving({slide, -fall}, spin))};
  scene.contacts = {rule};
  without_error_control(scene, 0.02);
  return scene;
}

/// EXACT: friction turns a disc that slides all through, I = m R^2/2: R dw = 2 dv, whichever way it slides; both go
/// with the normal impulse. The lever is R less the depth, some 1e-3 here, and a facet's. A disc that spins bounces
/// elastically: nodes of a dashpot that come down push more than those that go up, and so hinder its spin.
TEST(ObliqueImpact, a_sliding_disc_starts_to_spin) {
  constexpr double friction = 0.2;
  for (const auto& [slide, spin, e] :
       {std::tuple(0.3, 0.0, 0.5), std::tuple(-0.3, 0.0, 0.5), std::tuple(0.0, 0.3, 1.0)}) {
    ContactRule rule = rough_and_bouncing(friction, e);
    rule.stiffness = 1e5;
    const Impact hit = impact(thrown_disc(rule, slide, spin), 1.0);
    const double way = slide + spin > 0 ? 1 : -1;  // of the lowest point: v + R w
    EXPECT_GT(way * (hit.after[0] + hit.after[2]), 0.2) << "it slides all through";
    EXPECT_GT(hit.change()[1], 1.2 * fall) << "it bounces";
    EXPECT_NEAR(-way * hit.change()[0] / (friction * hit.change()[1]), 1, 3e-3) << "of mu: the slip at the start";
    EXPECT_NEAR(hit.change()[2] / (2 * hit.change()[0]), 1, 3e-3) << "depth over radius";
  }
}

}  // namespace
}  // namespace pliant::dynamics_tests
