#include "discretisation/consistent_gradients.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "../geometry/shapes.hpp"
#include "discretisation/methods.hpp"
#include "discretisation/mls.hpp"

namespace pliant {
namespace {

using Eigen::MatrixX2d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

FieldMesh mesh_in_node_distances(const ShapeSpec& shape) {
  FieldMesh mesh = make_field_mesh(shape);
  const double area = polygon_properties(testing::outline_of(mesh)).area;
  for (Vec2& x : mesh.nodes) x /= std::sqrt(area / static_cast<double>(mesh.nodes.size()));
  return mesh;
}

// EXACT: area vectors of a closed outline sum to zero; with the positions they give twice the area (divergence theorem,
// the trapezoidal rule is exact on straight segments).
TEST(ConsistentGradients, TributaryVectorsObeyTheDivergenceTheorem) {
  for (const ShapeSpec& shape : testing::all_shapes()) {
    const FieldMesh mesh = mesh_in_node_distances(shape);
    const Points s = tributary_vectors(mesh);
    Vec2 sum(0, 0);
    double flux = 0;
    for (std::size_t k = 0; k < s.size(); ++k) sum += s[k], flux += s[k].dot(mesh.nodes[k]);
    EXPECT_LT(sum.norm(), 1e-12);
    EXPECT_NEAR(flux / (2 * polygon_properties(testing::outline_of(mesh)).area), 1, 1e-13);
  }
}

// All constraints of one component as dense rows over the entries of the table scaled by sqrt(w): (1), then (2).
MatrixXd dense_constraints(const IntegrationTable& table, const FieldMesh& mesh) {
  const auto points = static_cast<int>(table.weight.size()), nodes = static_cast<int>(mesh.nodes.size());
  MatrixXd rows = MatrixXd::Zero(3 * points + nodes, static_cast<int>(table.node.size()));
  for (int g = 0; g < points; ++g)
    for (int e = table.start[g]; e < table.start[g + 1]; ++e) {
      const double root = std::sqrt(table.weight[g]);
      rows.block<3, 1>(3 * g, e) << 1, mesh.nodes[table.node[e]];
      rows.block<3, 1>(3 * g, e) /= root;
      rows(3 * points + table.node[e], e) = root;
    }
  return rows;
}

// INDEPENDENT: the correction is the least one, that of a dense complete orthogonal decomposition of all constraints.
TEST(ConsistentGradients, ChangeIsTheLeast) {
  const FieldMesh mesh = mesh_in_node_distances(testing::disc(40));
  const MlsNodes nodes = make_mls_nodes(mesh.nodes, 9);
  const Basis basis = moving_least_squares(nodes);
  const ShapeRows outline_rows = rows_at_outline(mesh, rows_at_nodes(mesh, basis));
  const IntegrationTable before = build_at_gauss_points(mesh, basis, 1).table;
  IntegrationTable after = before;
  make_gradients_consistent(after, mesh, outline_rows);

  const MatrixXd constraints = dense_constraints(before, mesh);
  const auto first_node = static_cast<int>(3 * before.weight.size());
  MatrixX2d lacking = MatrixX2d::Zero(constraints.rows(), 2);
  const Points moments = boundary_moments(mesh, outline_rows);
  for (int i = 0; i < static_cast<int>(moments.size()); ++i) lacking.row(first_node + i) = moments[i].transpose();
  for (std::size_t g = 0; g < before.weight.size(); ++g)
    for (int e = before.start[g]; e < before.start[g + 1]; ++e)
      lacking.row(first_node + before.node[e]) -= before.weight[g] * before.gradient[e].transpose();
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
  decomposition.setThreshold(1e-10);
  decomposition.compute(constraints);
  EXPECT_EQ(decomposition.rank(), constraints.rows() - 3);  // rank 6 short in both components together
  const MatrixX2d change = decomposition.solve(lacking);
  double largest = 0;
  for (std::size_t g = 0; g < before.weight.size(); ++g)
    for (int e = before.start[g]; e < before.start[g + 1]; ++e) {
      const Vec2 expected = change.row(e).transpose() / std::sqrt(before.weight[g]);
      EXPECT_LT((after.gradient[e] - before.gradient[e] - expected).norm(), 1e-12);
      largest = std::max(largest, expected.norm());
    }
  EXPECT_GT(largest, 1e-4);
}

// EXACT: the residual that the method reports sees a gradient moved by 1e-6.
TEST(ConsistentGradients, ResidualSeesAChange) {
  const FieldMesh mesh = mesh_in_node_distances(testing::disc(84));
  const MlsNodes nodes = make_mls_nodes(mesh.nodes, 9);
  const Basis basis = moving_least_squares(nodes);
  const ShapeRows outline_rows = rows_at_outline(mesh, rows_at_nodes(mesh, basis));
  IntegrationTable table = build_mls(mesh, basis, outline_rows).table;
  EXPECT_LT(consistency_residual(table, mesh, outline_rows), 1e-12);
  table.gradient[10].x() += 1e-6;
  EXPECT_GT(consistency_residual(table, mesh, outline_rows), 9e-7);
}

}  // namespace
}  // namespace pliant
