#include "reference/system.hpp"

#include <gtest/gtest.h>

#include "reference/tangent_error.hpp"
#include "setup/build_model.hpp"
#include "support/random.hpp"
#include "support/simulations.hpp"

namespace pliant::reference_tests {
namespace {

using namespace dynamics_tests;
using reference::Forces;
using reference::MassMatrix;
using reference::Motion;
using reference::System;
using reference::Vector;

/// Everything at once: compliant and rigid discs between walls, touching, with friction, gravity, a pressure that
/// follows, a soft support with a dashpot, mass damping, viscosity and a servo wall.
Scene everything() {
  Scene scene = small_third_body(1);
  scene.gravity = {0.01, -0.02};
  scene.contacts = {mohr_coulomb(40, 0.4)};
  scene.materials[0].mass_damping = 0.3;
  scene.materials[0].viscosity = 0.2;
  scene.materials[1].mass_damping = 0.1;
  scene.walls[1].y.damping = 0.7;
  BoundaryCondition pressure;
  pressure.kind = BoundaryCondition::Kind::pressure;
  pressure.grains = "layer";
  pressure.number = 1;
  pressure.pressure = {{0, 1}, {0.02, 0.05}};
  scene.boundary.push_back(pressure);
  BoundaryCondition support;
  support.kind = BoundaryCondition::Kind::support;
  support.grains = "layer";
  support.stiffness = 3;
  support.damping = 0.5;
  support.x.mode = AxisCondition::Mode::velocity;
  support.x.history = {{0}, {0.1}};
  support.part = {.kind = OutlinePart::Kind::side, .side = {0, 1}};
  // On compliant grains only.
  for (int number = 0; number < 12; ++number) {
    support.number = number;
    pressure.number = number;
    scene.boundary.push_back(support);
  }
  return scene;
}

/// Without the conditions on rigid grains, which have no supports.
Scene on_compliant_grains(Scene scene) {
  const reference::Bodies bodies([&] {
    Scene bare = scene;
    bare.boundary.clear();
    return bare;
  }());
  std::erase_if(scene.boundary, [&](const BoundaryCondition& condition) {
    return !bodies.all()[static_cast<std::size_t>(*condition.number)].compliant();
  });
  return scene;
}

/// Pressed together, sheared and shaken a little.
Motion shaken(const System& system, std::uint64_t seed, double amount) {
  testing::Random random(seed);
  Motion motion{system.bodies().initial_positions(), system.bodies().initial_velocities(), 0.3};
  for (int i = 0; i < motion.q.size(); ++i) {
    motion.q[i] += random.uniform(-amount, amount);
    motion.v[i] += random.uniform(-1, 1);
  }
  for (const reference::Body& body : system.bodies().all())
    for (int i = 1; i < body.dofs && !body.placed.wall; i += body.compliant() ? 2 : 3)
      motion.q[body.first_dof + i] *= 0.99;
  return motion;
}

TEST(ReferenceSystem, tangent_is_the_derivative_of_the_residual) {
  System system(on_compliant_grains(everything()));
  system.evaluate(Motion{system.bodies().initial_positions(), system.bodies().initial_velocities(), 0}, false);
  system.accept();
  const Motion motion = shaken(system, 5, 0.004);
  const Forces forces = system.evaluate(motion, true);
  ASSERT_GT(forces.contacts.elements.size(), 20U);
  // INDEPENDENT: the remainder of central differences, third derivative x step^2 / 6, is of that size; contacts that
  // close within the step would be seen as more.
  EXPECT_LT(tangent_error(system, motion, true, 1e-6), 1e-6);
  EXPECT_LT(tangent_error(system, motion, false, 1e-3), 1e-9);
}

// EXACT: at rest the residual of yielding bodies is the gradient of their potential, with the work that flow takes
// since the last accepted state. Central differences by h are off by h^2/6 of third derivatives and, where points begin
// to flow within a step, by h of second ones: 1e-6 of a stiffness over strains of 0.01.
TEST(ReferenceSystem, potential_of_plastic_bodies_at_rest) {
  Scene scene = free_disc(40, 1);
  Material& material = scene.materials[0];
  material.law = MaterialLaw::von_mises;
  material.yield = 0.005 * material.young, material.hardening = 0.02 * material.young;
  System system(scene);
  Motion motion = shaken(system, 3, 0.01);
  motion.moves = false;
  const Forces at = system.evaluate(motion, false);
  ASSERT_GT(at.plastic_loss, 0.1 * at.strain);
  testing::Random random(4);
  const double h = 1e-6;
  for (int sample = 0; sample < 5; ++sample) {
    Vector step(motion.q.size());
    for (int i = 0; i < step.size(); ++i) step[i] = random.uniform(-1, 1);
    Motion up = motion, down = motion;
    up.q += h * step, down.q -= h * step;
    const double change = (system.evaluate(up, false).potential - system.evaluate(down, false).potential) / (2 * h);
    EXPECT_NEAR(change, at.residual.dot(step), 1e-4 * at.residual.cwiseAbs().dot(step.cwiseAbs()));
  }
}

TEST(ReferenceSystem, kinds_in_turn_are_those_of_the_engine) {
  Scene scene = small_third_body(1);
  scene.grains[0].species_order = SpeciesOrder::in_turn;
  const Model model = build_model(scene);
  const reference::Bodies bodies(scene);
  // EXACT: up each of three columns of four, whose grains are numbered along rows.
  ASSERT_EQ(bodies.all().size(), 14U);
  for (std::size_t i = 0; i < 12; ++i) {
    const PlacedBody& body = bodies.all()[i].placed;
    EXPECT_EQ(body.kind, i / 3 % 2 == 0 ? BodyKind::compliant : BodyKind::rigid) << body.name;
    EXPECT_EQ(model.bodies[i].kind, body.kind) << body.name;
    EXPECT_EQ(model.bodies[i].angle, body.angle) << body.name;
  }
}

TEST(ReferenceSystem, sums_of_masses) {
  Scene scene = small_third_body(1);
  scene.grains[0].size = {.kind = SizeDistribution::Kind::uniform, .low = 0.8, .high = 1};
  scene.discretisation.mass_scaling = 3;
  const System system(scene);
  for (const MassMatrix kind :
       {MassMatrix::lumped, MassMatrix::scaled, MassMatrix::consistent, MassMatrix::corrected}) {
    const reference::SparseMatrix mass = system.bodies().mass(kind);
    for (const reference::Body& body : system.bodies().all()) {
      Vector along = Vector::Zero(system.bodies().dofs());
      for (int i = 0; i < (body.compliant() ? body.dofs : 2); i += 2) along[body.first_dof + i] = 1;
      // EXACT: shape functions sum to one, and D^-1 M keeps constants.
      EXPECT_NEAR(along.dot(mass * along), body.mass, 1e-12 * body.mass) << body.placed.name;
    }
  }
}

TEST(ReferenceSystem, corrected_mass_is_the_inverse_of_the_engines) {
  const System system(free_disc(60, 1));
  const reference::Space& space = system.bodies().space_of(system.bodies().all()[0]);
  const Eigen::MatrixXd inverse = space.lumped.cwiseInverse().asDiagonal(), consistent = space.consistent;
  const Eigen::MatrixXd engine = 2 * inverse - inverse * consistent * inverse;
  const Eigen::MatrixXd mass = system.bodies().mass(MassMatrix::corrected);
  // EXACT: docs/method.md 2.
  for (int i = 0; i < engine.rows(); ++i)
    for (int j = 0; j < engine.cols(); ++j) {
      double product = 0;
      for (int k = 0; k < engine.rows(); ++k) product += engine(i, k) * mass(2 * k, 2 * j);
      EXPECT_NEAR(product, i == j ? 1 : 0, 1e-11);
    }
}

}  // namespace
}  // namespace pliant::reference_tests
