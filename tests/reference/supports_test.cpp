#include <gtest/gtest.h>

#include "reference/both.hpp"
#include "support/simulations.hpp"

namespace pliant::reference_tests {
namespace {

using namespace dynamics_tests;
using reference::SolverOptions;
using reference::Vector;

BoundaryCondition dragged(double speed, double damping) {
  BoundaryCondition support;
  support.grains = "square";
  support.kind = BoundaryCondition::Kind::support;
  support.stiffness = 5;
  support.damping = damping;
  support.part = {.kind = OutlinePart::Kind::side, .side = {0, -1}};
  support.x.mode = support.y.mode = AxisCondition::Mode::velocity;
  support.x.history = {{0, 0.5}, {0, speed}}, support.y.history = constant(0.0);
  return support;
}

/// A square on supports.
Scene held(const std::vector<BoundaryCondition>& supports, double end) {
  Scene scene = empty_scene(end);
  scene.shapes = {box_shape("square", 1, 1, 0.25)};
  scene.grains = {grains("square", "square", BodyKind::compliant, {{0, 0}})};
  scene.boundary = supports;
  return scene;
}

double apart(const Vector& a, const Vector& b) { return (a - b).cwiseAbs().maxCoeff(); }

// EXACT: a dashpot does not act at rest, nor does a material's viscosity.
TEST(ReferenceStatics, knows_no_damping) {
  SolverOptions options;
  options.statics = true;
  Scene damped = held({dragged(0.1, 3)}, 1), undamped = held({dragged(0.1, 0)}, 1);
  damped.materials[0].viscosity = 0.5;
  for (Scene* scene : {&damped, &undamped}) {
    BoundaryCondition pressure;
    pressure.grains = "square";
    pressure.kind = BoundaryCondition::Kind::pressure;
    pressure.following = false;
    pressure.part = {.kind = OutlinePart::Kind::side, .side = {0, 1}};
    pressure.pressure = {{0, 1}, {0, 0.2}};
    scene->boundary.push_back(pressure);
  }
  const Vector rest = run_reference(undamped, 4, options);
  EXPECT_GT(apart(rest, ReferenceRun(undamped, options).stepping.motion().q), 0.05);
  EXPECT_LT(apart(run_reference(damped, 4, options), rest), 1e-12);
}

// INDEPENDENT: two supports of the same nodes whose dashpots are dragged at different speeds. RATE: the engine's
// dashpots see the half step before.
TEST(ReferenceSupports, add_up_on_a_node) {
  const Scene scene = held({dragged(0.2, 3), dragged(-0.1, 1)}, 0.5);
  const Vector reference = run_reference(scene, 200);
  const double coarse = apart(run_engine(scene, 0.2), reference), fine = apart(run_engine(scene, 0.05), reference);
  EXPECT_NEAR(std::log(coarse / fine) / std::log(4), 1, 0.1);
  EXPECT_LT(fine, 2e-3 * 0.05) << "of the faster support's way";
}

TEST(ReferenceSupports, balance_energy_together) {
  ReferenceRun run(held({dragged(0.2, 3), dragged(-0.1, 1)}, 0.5), {});
  run.run(200);
  EXPECT_GT(run.stepping.balance().dissipated_by_damping, 1e-3);
  EXPECT_LT(run.stepping.balance().balance_error(), 1e-4) << "RATE: trapezoidal rule, steps of 0.0025";
}

}  // namespace
}  // namespace pliant::reference_tests
