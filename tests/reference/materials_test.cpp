// The reference solver's energies, their stresses and tangents by automatic differentiation, and the forces of one
// body.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <complex>

#include "reference/jet.hpp"
#include "reference/materials/energy.hpp"
#include "reference/materials/internal.hpp"
#include "reference/shapes.hpp"
#include "support/random.hpp"

namespace pliant::reference {
namespace {

using namespace pliant::testing;
using Complex = std::complex<double>;

constexpr double tiny = 1e-30;  // complex step: no cancellation
constexpr double material_rounding = 1e-13;

const MaterialLaw elastic_laws[] = {MaterialLaw::neo_hookean, MaterialLaw::neo_hookean_quadratic, MaterialLaw::melody,
                                    MaterialLaw::linear_elastic};

Material material_of(MaterialLaw law, double young = 2.8, double poisson = 0.4) {
  Material material{"soft", law, 1, young, poisson};
  return material;
}

Deformation<double> random_deformation(Random& random) {
  const auto entry = [&] { return random.uniform(-0.3, 0.3); };
  return {1 + entry(), entry(), entry(), 1 + entry()};
}

template <int N>
Deformation<Jet<N>> variables(const Deformation<double>& F) {
  Deformation<Jet<N>> jets{{F.xx, 0}, {F.xy, 1}, {F.yx, 2}, {F.yy, 3}};
  if constexpr (N > 4) jets.zz = Jet<N>(F.zz, 4);
  return jets;
}

double& entry(Deformation<double>& F, int i) {
  double* entries[] = {&F.xx, &F.xy, &F.yx, &F.yy, &F.zz};
  return *entries[i];
}

TEST(ReferenceMaterials, exact_value) {
  // lambda = 4 mu, mu = 1: nu = 0.4, E = 2.8.
  const Jet<4> psi = strain_energy(material_of(MaterialLaw::neo_hookean), variables<4>({1.2, 0.3, -0.1, 0.85}));
  EXPECT_NEAR(psi.value, 0.0872207960699283, 1e-15) << "EXACT: docs/method.md 3";
  const double P[] = {0.5484633887391133, 0.2233486339693074, 0.1299540980920776, -0.0698163923683106};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(psi.gradient[i], P[i], 4e-15) << "EXACT: lambda of nu in rounding";
}

TEST(ReferenceMaterials, stress_is_the_derivative_by_complex_step) {
  Random random(1);
  for (const MaterialLaw law : elastic_laws)
    for (int sample = 0; sample < 50; ++sample) {
      const Material material = material_of(law);
      Deformation<double> F = random_deformation(random);
      F.zz = 1.1;
      const Jet<5> psi = strain_energy(material, variables<5>(F));
      for (int i = 0; i < 5; ++i) {
        Complex f[5] = {F.xx, F.xy, F.yx, F.yy, F.zz};
        f[i] += Complex(0, tiny);
        const Complex stepped = strain_energy(material, Deformation<Complex>{f[0], f[1], f[2], f[3], f[4]});
        EXPECT_NEAR(psi.gradient[i], stepped.imag() / tiny, material_rounding) << "EXACT: law " << int(law);
      }
    }
}

TEST(ReferenceMaterials, tangent_is_the_limit_of_differences) {
  Random random(2);
  for (const MaterialLaw law : elastic_laws)
    for (int sample = 0; sample < 20; ++sample) {
      const Material material = material_of(law);
      const Deformation<double> F = random_deformation(random);
      const Jet<4> psi = strain_energy(material, variables<4>(F));
      for (int i = 0; i < 4; ++i) {
        const auto error = [&](double h) {
          Deformation<double> above = F, below = F;
          entry(above, i) += h, entry(below, i) -= h;
          const Eigen::Vector4d difference = strain_energy(material, variables<4>(above)).gradient -
                                             strain_energy(material, variables<4>(below)).gradient;
          return (difference / (2 * h) - psi.hessian.col(i)).norm();
        };
        if (law == MaterialLaw::linear_elastic)
          EXPECT_LT(error(0.01), 1e-12) << "EXACT: quadratic";
        else
          EXPECT_NEAR(std::log2(error(0.01) / error(0.005)), 2, 0.1) << "RATE of 2, law " << int(law);
      }
    }
}

/// At rest all laws are the same: psi'' = lambda tr^2/2 + mu eps:eps for any strain.
TEST(ReferenceMaterials, small_strains_of_all_laws_are_those_of_hooke) {
  Eigen::Matrix4d hooke;  // mu = 1, lambda = 4; order xx, xy, yx, yy
  hooke << 6, 0, 0, 4, 0, 1, 1, 0, 0, 1, 1, 0, 4, 0, 0, 6;
  for (const MaterialLaw law : elastic_laws) {
    const Jet<4> psi = strain_energy(material_of(law), variables<4>({1, 0, 0, 1}));
    EXPECT_LT(psi.gradient.norm(), 1e-14) << "EXACT";
    EXPECT_LT((psi.hessian - hooke).norm(), 1e-13) << "EXACT: law " << int(law);
  }
}

/// A body of 60 nodes in any size and at any angle, with random displacements from its place.
struct Sample {
  Space space;
  Material material;
  double size, angle;
  Eigen::VectorXd rest, q, direction;

  Sample(DiscretisationMethod method, MaterialLaw law, std::uint64_t seed)
      : space(make_space(make_field_mesh(disc(60, 1)), settings_of(method))), material(material_of(law)) {
    Random random(seed);
    size = random.uniform(0.5, 2), angle = random.uniform(0, 6);
    const Eigen::Rotation2Dd turned(angle);
    rest.resize(2 * static_cast<Eigen::Index>(space.mesh.nodes.size()));
    q = direction = rest;
    for (Eigen::Index i = 0; i < rest.size() / 2; ++i)
      rest.segment<2>(2 * i) = size * (turned * space.mesh.nodes[static_cast<std::size_t>(i)]);
    for (double& x : direction) x = random.uniform(-1, 1);
    for (Eigen::Index i = 0; i < rest.size(); ++i) q[i] = 1.1 * rest[i] + 0.005 * size * random.uniform(-1, 1);
  }
  InternalForces forces() const { return {space, material, size, angle}; }
};

const DiscretisationMethod all_methods[] = {DiscretisationMethod::mls, DiscretisationMethod::mls_gauss,
                                            DiscretisationMethod::t3, DiscretisationMethod::es_t3};

TEST(ReferenceInternalForces, residual_and_tangent_are_the_limits_of_differences) {
  for (const DiscretisationMethod method : all_methods)
    for (const MaterialLaw law : elastic_laws) {
      Sample sample(method, law, 7);
      sample.material.viscosity = 0.3;
      const InternalForces forces = sample.forces();
      const InternalState state = forces.evaluate(sample.q, true);
      const double h = 1e-5;
      const Eigen::VectorXd step = h * sample.direction;
      const InternalState above = forces.evaluate(sample.q + step, false),
                          below = forces.evaluate(sample.q - step, false);
      const double slope = (above.energy - below.energy) / (2 * h);
      const auto expect_change = [&](const Eigen::SparseMatrix<double>& tangent, const Eigen::VectorXd& difference) {
        EXPECT_LT((tangent * sample.direction - difference / (2 * h)).norm(), 1e-6 * difference.norm() / (2 * h))
            << "EXACT: h^2 of third derivatives";
      };
      EXPECT_NEAR(state.residual.dot(sample.direction) / slope, 1, 1e-6) << "EXACT: as there";
      expect_change(state.tangent, above.residual - below.residual);
      const Eigen::VectorXd v = sample.q - sample.rest;
      const ViscousState damping = forces.damping(sample.q, v, true);
      expect_change(damping.by_positions, forces.damping(sample.q + step, v, false).residual -
                                              forces.damping(sample.q - step, v, false).residual);
      expect_change(damping.by_velocities, forces.damping(sample.q, v + step, false).residual -
                                               forces.damping(sample.q, v - step, false).residual);
    }
}

TEST(ReferenceInternalForces, start_at_rest_and_do_not_see_rotations) {
  for (const DiscretisationMethod method :
       {DiscretisationMethod::mls, DiscretisationMethod::t3, DiscretisationMethod::es_t3})
    for (const MaterialLaw law : elastic_laws) {
      const Sample sample(method, law, 8);
      const InternalState state = sample.forces().evaluate(sample.rest, false);
      EXPECT_LT(state.residual.cwiseAbs().maxCoeff(), 1e-12) << "EXACT";
      EXPECT_NEAR(state.energy, 0, 1e-13) << "EXACT";
      EXPECT_NEAR(state.least_jacobian, 1, 1e-12) << "EXACT";
    }
}

TEST(ReferenceInternalForces, affine_states_have_the_stress_of_their_law) {
  for (const MaterialLaw law : elastic_laws) {
    const Sample sample(DiscretisationMethod::mls, law, 9);
    const InternalForces forces = sample.forces();
    const Deformation<double> G{1.1, 0.2, -0.05, 0.9};
    Eigen::Matrix2d matrix;
    matrix << G.xx, G.xy, G.yx, G.yy;
    Eigen::VectorXd q = sample.rest;
    for (Eigen::Index i = 0; i < q.size() / 2; ++i) q.segment<2>(2 * i) = matrix * sample.rest.segment<2>(2 * i);
    const Jet<5> psi = strain_energy(sample.material, variables<5>(G));
    const bool small = law == MaterialLaw::linear_elastic;
    const Eigen::Matrix2d P =
        (Eigen::Matrix2d() << psi.gradient[0], psi.gradient[1], psi.gradient[2], psi.gradient[3]).finished();
    const double J = matrix.determinant();
    const Eigen::Matrix2d cauchy = small ? P : Eigen::Matrix2d(P * matrix.transpose() / J);
    for (const PointStress& at : forces.stresses(q)) {
      EXPECT_NEAR(at.xx, cauchy(0, 0), 1e-11) << "EXACT: isotropic laws do not see the initial rotation";
      EXPECT_NEAR(at.xy, cauchy(0, 1), 1e-11) << "EXACT";
      EXPECT_NEAR(at.xy, cauchy(1, 0), 1e-11) << "EXACT";
      EXPECT_NEAR(at.yy, cauchy(1, 1), 1e-11) << "EXACT";
      EXPECT_NEAR(at.zz, psi.gradient[4] / (small ? 1 : J), 1e-11) << "EXACT";
      EXPECT_NEAR(at.jacobian, J, 1e-12) << "EXACT";
    }
    EXPECT_NEAR(forces.evaluate(q, false).energy, forces.weights().sum() * psi.value, 1e-11) << "EXACT";
  }
}

TEST(ReferenceInternalForces, find_the_point_that_is_turned_over) {
  Sample sample(DiscretisationMethod::t3, MaterialLaw::neo_hookean, 10);
  Eigen::VectorXd q = sample.rest;
  q.head<2>() *= -1;  // node 0, of the outline, beyond the centre
  const InternalState state = sample.forces().evaluate(q, false);
  const std::vector<int>& nodes = sample.space.points[static_cast<std::size_t>(state.least_point)].node;
  EXPECT_LT(state.least_jacobian, 0);
  EXPECT_EQ(nodes.front(), 0) << "EXACT: only its triangles are";
}

TEST(ReferenceInternalForces, viscosity_resists_no_rotation_and_dissipates_what_the_law_says) {
  Sample sample(DiscretisationMethod::mls, MaterialLaw::neo_hookean, 11);
  sample.material.viscosity = 0.7;
  const InternalForces forces = sample.forces();
  Eigen::VectorXd spin = sample.q;
  for (Eigen::Index i = 0; i < spin.size(); i += 2) spin.segment<2>(i) << -sample.q[i + 1], sample.q[i];
  EXPECT_LT(forces.damping(sample.q, spin, false).residual.norm(), 1e-12) << "EXACT: rounding";
  // Growth at the rate 1 from the rest: E_dot = 1, so that 2 eta E_dot : E_dot = 4 eta per area.
  const double power = forces.damping(sample.rest, sample.rest, false).residual.dot(sample.rest);
  EXPECT_NEAR(power, 4 * 0.7 * forces.weights().sum(), 1e-12 * power) << "EXACT";
}

}  // namespace
}  // namespace pliant::reference
