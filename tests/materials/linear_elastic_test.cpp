// Linear elasticity: a check for small strains, so it is checked against the finite-strain law at small strains.
#include "materials/linear_elastic.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "bodies/nodal.hpp"
#include "bodies/small_strain.hpp"
#include "dynamics/true_spectrum.hpp"
#include "setup/build_model.hpp"
#include "support/material_points.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

// EXACT: P = dpsi/dF by complex step, and sigma_zz = lambda tr e.
TEST(LinearElastic, StressIsTheDerivativeOfTheEnergy) {
  testing::Random random(1);
  for (int sample = 0; sample < 50; ++sample) {
    const Tensor<double> F = random_deformation(random, 0.3);
    const Tensor<double> P = LinearElastic<double>{mu, lambda}.respond(F).P;
    const double entries[4] = {P.xx, P.xy, P.yx, P.yy};
    for (int entry = 0; entry < 4; ++entry) {
      Complex f[4] = {F.xx, F.xy, F.yx, F.yy};
      f[entry] += Complex(0, tiny);
      const double slope = LinearElastic<Complex>{mu, lambda}.energy({f[0], f[1], f[2], f[3]}).imag() / tiny;
      EXPECT_NEAR(entries[entry], slope, 1e-14);
    }
    EXPECT_NEAR((LinearElastic<double>{mu, lambda}.sigma_zz(F)), lambda * (F.xx + F.yy - 2), 1e-15);
  }
}

Scene disc_of(MaterialLaw law) {
  Scene scene = free_disc(60, 1);
  scene.materials[0].law = law;
  return scene;
}

/// Largest difference of the forces of both laws over the largest force, at random displacements of a size.
double difference_of_forces(double size) {
  Bench linear(disc_of(MaterialLaw::linear_elastic)), finite(disc_of(MaterialLaw::neo_hookean));
  testing::Random random(2);
  for (std::size_t i = 0; i < linear.model.compliant_size; ++i) {
    const Lanes step = broadcast(random.uniform(-size, size));
    linear.state.position.compliant[i] += step;
    finite.state.position.compliant[i] += step;
  }
  linear.evaluate_here();
  finite.evaluate_here();
  double largest_force = 0, largest_difference = 0;
  for (std::size_t i = 0; i < linear.model.compliant_size; ++i) {
    const double a = linear.state.force.compliant[i][0], b = finite.state.force.compliant[i][0];
    largest_force = std::max(largest_force, std::abs(b));
    largest_difference = std::max(largest_difference, std::abs(a - b));
  }
  return largest_difference / largest_force;
}

// RATE: second-order terms are a share of the strain; displacements of 1e-6 between nodes 0.2 apart strain by 1e-5.
TEST(LinearElastic, AgreesWithNeoHookeanAtSmallStrains) {
  EXPECT_LT(difference_of_forces(1e-6), 1e-4);
  EXPECT_NEAR(observed_order(difference_of_forces(1e-4), difference_of_forces(1e-6), 100), 1, 0.1);
}

// EXACT: the tangents at rest are the same; central differences of 1e-6 have third-order terms of 1e-10.
TEST(LinearElastic, HasTheModesOfNeoHookeanAtRest) {
  Bench linear(disc_of(MaterialLaw::linear_elastic)), finite(disc_of(MaterialLaw::neo_hookean));
  const double w2 = largest_square_frequency(finite);
  EXPECT_NEAR(largest_square_frequency(linear), w2, 1e-7 * w2);
}

// RATE: a disc squeezed from above and below by a pressure of 1e-5 mu: both laws move it alike, but for a share of some
// strains.
TEST(LinearElastic, CompressesAsNeoHookean) {
  const auto height = [](MaterialLaw law) {
    Scene scene = disc_of(law);
    scene.time.end = 1;
    for (const double direction : {0.5, 1.5}) {
      BoundaryCondition squeeze;
      squeeze.kind = BoundaryCondition::Kind::pressure;
      squeeze.grains = "disc";
      squeeze.pressure = constant(1e-5);
      squeeze.part = {.kind = OutlinePart::Kind::angles,
                      .first = (direction - 0.25) * std::numbers::pi,
                      .second = (direction + 0.25) * std::numbers::pi};
      scene.boundary.push_back(squeeze);
    }
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 1);
    const double strain = largest_small_strain(model, simulation.state().position);
    EXPECT_EQ(strain > 0, law == MaterialLaw::linear_elastic) << "EXACT: measured where the law needs it";
    const Points outline = outline_values(model, model.bodies[0], simulation.state().position);
    double top = 0;
    for (const Vec2& p : outline) top = std::max(top, p.y());
    double first = 0;
    for (const Vec2& p : model.outlines[0].points) first = std::max(first, p.y());
    return first - top;
  };
  const double finite = height(MaterialLaw::neo_hookean), linear = height(MaterialLaw::linear_elastic);
  EXPECT_GT(finite, 1e-6);
  EXPECT_NEAR(linear / finite, 1, 1e-4);
}

// EXACT: a rotation counts as a strain, and is measured.
TEST(LinearElastic, MeasuresRotationsAsStrains) {
  Scene scene = disc_of(MaterialLaw::linear_elastic);
  scene.grains[0].angle = 0.1;
  const Bench bench(scene);
  EXPECT_NEAR(largest_small_strain(bench.model, bench.state.position), std::sin(0.1), 1e-12);
}

}  // namespace
}  // namespace pliant::dynamics_tests
