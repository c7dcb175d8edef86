#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "../geometry/shapes.hpp"
#include "discretisation/consistent_gradients.hpp"
#include "discretisation/table.hpp"

namespace pliant {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double lambda = 4, mu = 1;  // plane strain, nu = 0.4

Matrix2d linear_stress(const Matrix2d& strain) {
  return lambda * strain.trace() * Matrix2d::Identity() + 2 * mu * strain;
}

// The mesh in units of order one: the patch test's tolerances are relative.
FieldMesh unit_mesh(const ShapeSpec& shape) {
  FieldMesh mesh = make_field_mesh(shape);
  const double size = std::sqrt(polygon_properties(testing::outline_of(mesh)).area);
  for (Vec2& x : mesh.nodes) x /= size;
  return mesh;
}

// Small-strain stiffness of a table, [2 nodes x 2 nodes].
MatrixXd stiffness(const Discretisation& d) {
  MatrixXd k = MatrixXd::Zero(2 * d.mesh.nodes.size(), 2 * d.mesh.nodes.size());
  for (std::size_t g = 0; g < d.table.weight.size(); ++g)
    for (int a = d.table.start[g]; a < d.table.start[g + 1]; ++a)
      for (int b = d.table.start[g]; b < d.table.start[g + 1]; ++b) {
        const Vec2 &p = d.table.gradient[a], &q = d.table.gradient[b];
        const Matrix2d block =
            lambda * p * q.transpose() + mu * q * p.transpose() + mu * p.dot(q) * Matrix2d::Identity();
        k.block<2, 2>(2 * d.table.node[a], 2 * d.table.node[b]) += d.table.weight[g] * block;
      }
  return k;
}

// Nodal forces of the tractions stress . n by the tributary rule.
VectorXd traction_forces(const Discretisation& d, const Matrix2d& stress) {
  VectorXd f(2 * d.mesh.nodes.size());
  const Points moments = boundary_moments(d.mesh, d.outline_rows);
  for (std::size_t i = 0; i < moments.size(); ++i) f.segment<2>(2 * static_cast<int>(i)) = stress * moments[i];
  return f;
}

// Static displacements; rigid motions, which do no work, are held by a stiffness of their own.
VectorXd solve(const Discretisation& d, const VectorXd& force) {
  MatrixXd rigid = MatrixXd::Zero(force.size(), 3);
  for (int i = 0; i < force.size() / 2; ++i) {
    rigid(2 * i, 0) = rigid(2 * i + 1, 1) = 1;
    rigid.block<2, 1>(2 * i, 2) = Vec2(-d.mesh.nodes[i].y(), d.mesh.nodes[i].x());
  }
  const MatrixXd k = stiffness(d) + rigid * rigid.transpose();
  const Eigen::LDLT<MatrixXd> factorisation(k);
  VectorXd u = factorisation.solve(force);
  u += factorisation.solve(force - k * u);
  return u;
}

// Rms over the points, weighted, of the strain's deviation from the uniform one, relative to it.
double rms_strain_error(const Discretisation& d, const Matrix2d& strain) {
  const VectorXd u = solve(d, traction_forces(d, linear_stress(strain)));
  double sum = 0, area = 0;
  for (std::size_t g = 0; g < d.table.weight.size(); ++g) {
    Matrix2d gradient = Matrix2d::Zero();
    for (int e = d.table.start[g]; e < d.table.start[g + 1]; ++e)
      gradient += u.segment<2>(2 * d.table.node[e]) * d.table.gradient[e].transpose();
    sum += d.table.weight[g] * (0.5 * (gradient + gradient.transpose()) - strain).squaredNorm();
    area += d.table.weight[g];
  }
  return std::sqrt(sum / area) / strain.norm();
}

Matrix2d patch_strain() { return (Matrix2d() << 0.7, 0.3, 0.3, -0.4).finished(); }

// EXACT: internal forces of a uniform stress, not of small strain only, balance the tributary tractions; rounding of
// sums of some 100 terms.
TEST(PatchTest, UniformStressBalancesTractions) {
  const Matrix2d stress = (Matrix2d() << 1.0, 0.4, -0.2, 0.7).finished();
  for (const ShapeSpec& shape : testing::all_shapes()) {
    const Discretisation d = discretise(unit_mesh(shape), {.method = DiscretisationMethod::mls});
    VectorXd residual = traction_forces(d, stress);
    for (std::size_t g = 0; g < d.table.weight.size(); ++g)
      for (int e = d.table.start[g]; e < d.table.start[g + 1]; ++e)
        residual.segment<2>(2 * d.table.node[e]) -= d.table.weight[g] * stress * d.table.gradient[e];
    EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-12);
  }
}

// EXACT: residual 1e-14 of the table times the condition of the stiffness, some 1e3: 1e-10.
TEST(PatchTest, MlsReproducesUniformStrain) {
  for (const ShapeSpec& shape : testing::all_shapes())
    for (const int support : {8, 9, 12}) {
      const Discretisation d = discretise(unit_mesh(shape), {.method = DiscretisationMethod::mls, .support = support});
      const double error = rms_strain_error(d, patch_strain());
      EXPECT_LT(error, 1e-10) << shape.name << ", support " << support;
      RecordProperty(shape.name + std::to_string(support), fmt::format("{:.2e}", error));
    }
}

// EXACT: finite elements, plain and smoothed, pass too.
TEST(PatchTest, TrianglesReproduceUniformStrain) {
  for (const ShapeSpec& shape : testing::all_shapes())
    for (const DiscretisationMethod method : {DiscretisationMethod::t3, DiscretisationMethod::es_t3})
      EXPECT_LT(rms_strain_error(discretise(unit_mesh(shape), {.method = method}), patch_strain()), 1e-11)
          << shape.name;
}

// Radial point interpolation is not even compatible: it fails, and this shows that the test can.
TEST(PatchTest, RpimFails) {
  const Discretisation d =
      discretise(unit_mesh(testing::disc(168)), {.method = DiscretisationMethod::rpim, .gauss_points = 3});
  const double error = rms_strain_error(d, patch_strain());
  EXPECT_GT(error, 1e-3);
  RecordProperty("rms_strain_error", fmt::format("{:.2e}", error));
}

// INDEPENDENT: the prototype of docs/method.md 2 has 2e-2 with 3 points; ours must be of that size, within a factor of
// 3 either
// way: the known flaw of the paper's method.
TEST(PatchTest, MlsGaussFailsAsKnown) {
  const Discretisation d =
      discretise(unit_mesh(testing::disc(168)), {.method = DiscretisationMethod::mls_gauss, .gauss_points = 3});
  const double error = rms_strain_error(d, patch_strain());
  EXPECT_GT(error, 2e-2 / 3);
  EXPECT_LT(error, 2e-2 * 3);
  RecordProperty("rms_strain_error", fmt::format("{:.2e}", error));
}

}  // namespace
}  // namespace pliant
