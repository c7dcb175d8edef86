#include "reference/newton.hpp"

#include <gtest/gtest.h>

#include "reference/both.hpp"
#include "support/simulations.hpp"

namespace pliant::reference_tests {
namespace {

using namespace dynamics_tests;
using reference::Linearisation;
using reference::NewtonOptions;
using reference::NewtonResult;
using reference::SolverOptions;
using reference::StepRecord;
using reference::Vector;

/// The exponent p of r_(k+1) = c r_k^p from the last three residuals above rounding.
double convergence_order(const std::vector<double>& residuals) {
  std::vector<double> logs;
  for (const double r : residuals)
    if (r > 1e-13) logs.push_back(std::log(r));
  if (logs.size() < 3) return 0;
  const std::size_t n = logs.size();
  return (logs[n - 1] - logs[n - 2]) / (logs[n - 2] - logs[n - 3]);
}

std::string text(const std::vector<double>& residuals) {
  std::string result;
  for (const double r : residuals) result += std::to_string(std::log10(r)) + " ";
  return result;
}

void expect_quadratic(const StepRecord& record) {
  EXPECT_EQ(record.bisections, 0);
  EXPECT_LE(record.residuals.back(), 1e-10);
  // RATE: 2; the last residuals are those of few digits, so a half is left to them. A wrong tangent converges at 1.
  EXPECT_GT(convergence_order(record.residuals), 1.5) << text(record.residuals);
}

TEST(ReferenceNewton, converges_quadratically_without_contact) {
  ReferenceRun run(free_disc(60, 1, stretching(1.2)), {});
  expect_quadratic(run.stepping.step(0.4));
}

TEST(ReferenceNewton, converges_quadratically_with_all_that_is_unsymmetric_or_depends_on_velocities) {
  Scene scene = free_disc(60, 1, stretching(0.8));
  scene.materials[0].viscosity = 0.3;
  scene.materials[0].mass_damping = 2;
  scene.boundary.resize(2);
  for (BoundaryCondition& condition : scene.boundary) condition.grains = "disc";
  scene.boundary[0].kind = BoundaryCondition::Kind::pressure;
  scene.boundary[0].pressure = constant(0.5);
  scene.boundary[1].kind = BoundaryCondition::Kind::support;
  scene.boundary[1].stiffness = 1;
  scene.boundary[1].damping = 2;
  for (const double hht : {0.0, -0.3}) {
    SolverOptions options;
    options.hht = hht;
    expect_quadratic(ReferenceRun(scene, options).stepping.step(0.3));
    Scene viscous = scene;
    viscous.boundary.clear();
    expect_quadratic(ReferenceRun(viscous, options).stepping.step(0.3));
  }
}

Scene pressed_disc(const ContactRule& rule) {
  Scene scene = on_a_floor(1, 8, 0.2, {0, 0});
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("disc", "disc", BodyKind::compliant, {{4, 0.99}}, moving({0.3, -0.5}))};
  scene.contacts = {rule};
  return scene;
}

TEST(ReferenceNewton, converges_quadratically_in_frictionless_contact) {
  ReferenceRun run(pressed_disc(frictionless(40)), {});
  run.stepping.step(0.02);
  expect_quadratic(run.stepping.step(0.12));
}

TEST(ReferenceNewton, converges_quadratically_in_sticking_contact) {
  ReferenceRun run(pressed_disc(mohr_coulomb(40, 5)), {});
  run.stepping.step(0.02);
  const double before = run.stepping.balance().dissipated_by_contact;
  expect_quadratic(run.stepping.step(0.12));
  EXPECT_LT(run.stepping.balance().dissipated_by_contact - before, 1e-12);  // it sticks
}

/// x^3 = c, from far off.
TEST(ReferenceNewton, searches_along_the_line_and_keeps_to_admissible_places) {
  reference::LinearSolver solver;
  Vector x = Vector::Constant(1, 0.01);
  int refused = 0;
  const NewtonResult result = solve_newton(
      [&](const Vector& at, bool tangent) {
        Linearisation here;
        here.admissible = at[0] < 30;
        refused += !here.admissible;
        here.trouble = "beyond 30";
        here.residual = Vector::Constant(1, std::pow(at[0], 3) - 8);
        here.magnitude = Vector::Constant(1, 8);
        if (tangent) {
          here.matrix.resize(1, 1);
          here.matrix.insert(0, 0) = 3 * at[0] * at[0];
        }
        return here;
      },
      NewtonOptions{}, solver, x);
  EXPECT_TRUE(result.converged);
  EXPECT_GT(refused, 0);
  EXPECT_NEAR(x[0], 2, 1e-9);  // EXACT
}

/// Whole steps of Newton's method go farther and farther from the solution of atan x = 0.
TEST(ReferenceNewton, shortens_steps_that_raise_the_residual) {
  reference::LinearSolver solver;
  Vector x = Vector::Constant(1, 3.0);
  const NewtonResult result = solve_newton(
      [](const Vector& at, bool tangent) {
        Linearisation here;
        here.residual = Vector::Constant(1, std::atan(at[0]));
        here.magnitude = Vector::Constant(1, 1);
        if (tangent) {
          here.matrix.resize(1, 1);
          here.matrix.insert(0, 0) = 1 / (1 + at[0] * at[0]);
        }
        return here;
      },
      NewtonOptions{}, solver, x);
  EXPECT_TRUE(result.converged) << result.trouble;
  EXPECT_NEAR(x[0], 0, 1e-9);  // EXACT
}

TEST(ReferenceNewton, says_why_there_is_no_solution) {
  reference::LinearSolver solver;
  Vector x = Vector::Constant(1, 1.0);
  const NewtonResult result = solve_newton(
      [](const Vector& at, bool tangent) {
        Linearisation here;
        here.residual = here.magnitude = Vector::Constant(1, at[0] * at[0] + 1);
        if (tangent) {
          here.matrix.resize(1, 1);
          here.matrix.insert(0, 0) = 2 * at[0] + 1e-3;
        }
        return here;
      },
      NewtonOptions{}, solver, x);
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.trouble.find("no convergence in 40 iterations"), std::string::npos) << result.trouble;
}

}  // namespace
}  // namespace pliant::reference_tests
