#include "reference/relaxation.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "core/errors.hpp"
#include "reference/both.hpp"
#include "support/simulations.hpp"

namespace pliant::reference_tests {
namespace {

using namespace dynamics_tests;
using reference::Linearisation;
using reference::NewtonResult;
using reference::RelaxationOptions;
using reference::SolverOptions;
using reference::Vector;

/// Energy, its slope and its curvature at x.
using Landscape = std::array<double, 3> (*)(double x);

NewtonResult relax_in(Landscape landscape, double& x, double longest = 0.1) {
  reference::LinearSolver solver;
  Vector at = Vector::Constant(1, x);
  const NewtonResult result = relax(
      [&](const Vector& place, bool tangent) {
        Linearisation here;
        const auto [energy, slope, curvature] = landscape(place[0]);
        here.potential = energy;
        here.residual = Vector::Constant(1, slope);
        here.magnitude = Vector::Constant(1, 1.0);
        if (tangent) {
          here.matrix.resize(1, 1);
          here.matrix.insert(0, 0) = curvature;
        }
        return here;
      },
      Vector::Ones(1), Vector::Ones(1), RelaxationOptions{.longest = longest, .furthest = 100}, solver, at);
  x = at[0];
  return result;
}

// EXACT: the nearest minimum of x^4 / 4 - x^2 / 2; Newton's method would go to the maximum at 0.
TEST(ReferenceRelaxation, ends_in_a_minimum) {
  double x = 0.05;
  EXPECT_TRUE(relax_in(
                  [](double v) -> std::array<double, 3> {
                    return {std::pow(v, 4) / 4 - v * v / 2, v * v * v - v, 3 * v * v - 1};
                  },
                  x)
                  .converged);
  EXPECT_NEAR(x, 1, 1e-9);
}

// EXACT: the nearest of the two minima of min((x + 1)^2, (x - 2)^2): the kink at 1/2 is a maximum.
TEST(ReferenceRelaxation, leaves_a_kink_where_forces_push_from_it) {
  for (const bool left : {true, false}) {
    double x = left ? 0.499 : 0.501;
    EXPECT_TRUE(relax_in(
                    [](double v) -> std::array<double, 3> {
                      const double from = v < 0.5 ? v + 1 : v - 2;
                      return {from * from, 2 * from, 2};
                    },
                    x)
                    .converged);
    EXPECT_NEAR(x, left ? -1 : 2, 1e-9);
  }
}

// EXACT: x = 10.05 from 0, over twenty kinks that the force jumps up by 1 at, all of them downhill.
TEST(ReferenceRelaxation, goes_on_over_kinks_on_the_way_down) {
  double x = 0;
  const NewtonResult result = relax_in(
      [](double v) -> std::array<double, 3> {
        const double steps = std::clamp(std::floor(2 * v), 0.0, 20.0);
        double energy = v * v / 2 - 30.05 * v;
        for (int i = 1; i <= static_cast<int>(steps); ++i) energy += v - 0.5 * i;
        return {energy, v - 30.05 + steps, 1};
      },
      x);
  EXPECT_TRUE(result.converged) << result.trouble;
  EXPECT_NEAR(x, 10.05, 1e-8);
}

/// A disc that nothing keeps from spinning and from creeping sideways, closed in upon without friction by a tenth of
/// its diameter.
Scene between_plates(double angle) {
  Scene scene = empty_scene(10);
  scene.period = 4;
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("disc", "disc", BodyKind::compliant, {{2, 0}})};
  scene.grains[0].angle = angle;
  scene.materials[0].mass_damping = 1;
  scene.walls = {flat_wall("lower", Wall::Solid::below, -1.001, 0.2),
                 flat_wall("upper", Wall::Solid::above, 1.001, 0.2)};
  for (const bool upper : {false, true}) {
    scene.walls[upper].y.mode = AxisCondition::Mode::velocity;
    scene.walls[upper].y.history = constant(upper ? -0.0101 : 0.0101);
  }
  scene.contacts = {frictionless(300)};
  return scene;
}

double largest_force(const reference::Forces& forces, int free) {
  return forces.residual.head(free).cwiseAbs().maxCoeff();
}

TEST(ReferenceRelaxation, a_free_disc_between_frictionless_plates_finds_its_equilibria) {
  for (const double angle : {0.0, 0.03}) {
    SolverOptions options;
    options.statics = true;
    ReferenceRun run(between_plates(angle), options);
    run.run(20);
    const reference::Forces& forces = run.stepping.forces();
    const int free = run.system.bodies().all()[0].dofs;
    // EXACT: Newton's 1e-10 of what cancels.
    EXPECT_LT(largest_force(forces, free), 1e-8 * forces.magnitude.maxCoeff());
    EXPECT_GT(forces.contacts.elements.size(), 4U);
    EXPECT_TRUE(forces.symmetric);
    const Eigen::MatrixXd tangent = Eigen::MatrixXd(forces.stiffness).topLeftCorner(free, free);
    const Vector stiffnesses = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(tangent).eigenvalues();
    // EXACT: stable; it may creep, and turn, without any force, up to rounding of the largest.
    EXPECT_GT(stiffnesses.minCoeff(), -1e-10 * stiffnesses.maxCoeff()) << "angle " << angle;
  }
}

TEST(ReferenceRelaxation, newtons_method_alone_finds_no_equilibrium_of_a_free_disc) {
  SolverOptions options;
  options.statics = true;
  options.pseudo_inertia = 0;
  ReferenceRun run(between_plates(0), options);
  EXPECT_THROW(run.run(20), PhysicsError);
}

}  // namespace
}  // namespace pliant::reference_tests
