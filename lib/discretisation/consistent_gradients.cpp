#include "discretisation/consistent_gradients.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <limits>

#include "core/errors.hpp"
#include "discretisation/mls.hpp"

namespace pliant {
namespace {

using Eigen::MatrixX2d;
using Eigen::MatrixXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

constexpr double tolerance = 1e-12;
constexpr int refinement_steps = 4;

// Orthogonal projector onto the vectors over a point's neighbours that keep both completeness conditions: the
// complement of span(1, X, Y), [neighbours x neighbours].
MatrixXd completeness_projector(const IntegrationTable& table, const FieldMesh& mesh, std::size_t point) {
  const int begin = table.start[point], count = table.start[point + 1] - begin;
  Eigen::MatrixX3d basis(count, 3);
  for (int a = 0; a < count; ++a) {
    const Vec2 r = mesh.nodes[table.node[begin + a]] - mesh.nodes[table.node[begin]];
    basis.row(a) << 1, r.x(), r.y();
  }
  const MatrixXd q = basis.householderQr().householderQ() * MatrixXd::Identity(count, 3);
  return MatrixXd::Identity(count, count) - q * q.transpose();
}

// Three nodes that are far apart and not collinear. Their multipliers are set to zero, because linear fields over the
// nodes are the kernel of the system below (rank 3 for each component) and do not change the correction.
std::array<int, 3> pinned_nodes(const Points& nodes) {
  const auto farthest = [&](auto measure) {
    return static_cast<int>(
        std::max_element(nodes.begin(), nodes.end(), [&](auto& a, auto& b) { return measure(a) < measure(b); }) -
        nodes.begin());
  };
  const int a = farthest([](const Vec2& x) { return x.squaredNorm(); });
  const int b = farthest([&](const Vec2& x) { return (x - nodes[a]).squaredNorm(); });
  const int c = farthest([&](const Vec2& x) { return std::abs(cross(nodes[b] - nodes[a], x - nodes[a])); });
  return {a, b, c};
}

// Elimination of d_g = P_g lambda from the KKT system leaves, for each of the components,
// (sum_g w_g P_g) lambda = residual of condition (2): symmetric, and positive definite apart from its kernel.
class MultiplierSystem {
 public:
  MultiplierSystem(const IntegrationTable& table, const FieldMesh& mesh) : pinned_(pinned_nodes(mesh.nodes)) {
    for (std::size_t g = 0; g < table.weight.size(); ++g) projectors_.push_back(completeness_projector(table, mesh, g));
    factorisation_.compute(assemble(table, static_cast<int>(mesh.nodes.size())));
    const Eigen::VectorXd pivots = factorisation_.vectorD().cwiseAbs();
    if (factorisation_.info() != Eigen::Success || !(pivots.minCoeff() > tolerance * pivots.maxCoeff()))
      throw TooFewNeighbours("discretisation: `mls` finds no consistent gradients, its points have too few neighbours");
  }

  // Adds to the table the least change that adds `lacking` [nodes x 2] to sum_g w_g b_gi.
  void correct(IntegrationTable& table, MatrixX2d lacking) const {
    for (const int i : pinned_) lacking.row(i).setZero();
    const MatrixX2d lambda = factorisation_.solve(lacking);
    for (std::size_t g = 0; g < projectors_.size(); ++g) {
      const int begin = table.start[g], count = static_cast<int>(projectors_[g].rows());
      MatrixX2d local(count, 2);
      for (int a = 0; a < count; ++a) local.row(a) = lambda.row(table.node[begin + a]);
      const MatrixX2d change = projectors_[g] * local;
      for (int a = 0; a < count; ++a) table.gradient[begin + a] += change.row(a).transpose();
    }
  }

 private:
  bool is_pinned(int i) const { return std::find(pinned_.begin(), pinned_.end(), i) != pinned_.end(); }

  SparseMatrix assemble(const IntegrationTable& table, int nodes) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t g = 0; g < projectors_.size(); ++g)
      for (int a = 0; a < projectors_[g].rows(); ++a)
        for (int b = 0; b < projectors_[g].cols(); ++b) {
          const int i = table.node[table.start[g] + a], j = table.node[table.start[g] + b];
          if (!is_pinned(i) && !is_pinned(j)) entries.emplace_back(i, j, table.weight[g] * projectors_[g](a, b));
        }
    for (const int i : pinned_) entries.emplace_back(i, i, 1.0);
    SparseMatrix matrix(nodes, nodes);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  std::array<int, 3> pinned_;
  std::vector<MatrixXd> projectors_;
  Eigen::SimplicialLDLT<SparseMatrix> factorisation_;
};

// Residual of condition (2), [nodes x 2].
MatrixX2d lacking_moments(const IntegrationTable& table, const Points& moments) {
  MatrixX2d lacking(moments.size(), 2);
  for (std::size_t i = 0; i < moments.size(); ++i) lacking.row(i) = moments[i].transpose();
  for (std::size_t g = 0; g < table.weight.size(); ++g)
    for (int e = table.start[g]; e < table.start[g + 1]; ++e)
      lacking.row(table.node[e]) -= table.weight[g] * table.gradient[e].transpose();
  return lacking;
}

// Changes each point's gradients by the least amount that restores condition (1). Rounding of large multipliers
// violates it in meshes of tens of thousands of nodes.
void restore_completeness(IntegrationTable& table, const FieldMesh& mesh) {
  const Eigen::Matrix<double, 3, 2> wanted = (Eigen::Matrix<double, 3, 2>() << 0, 0, 1, 0, 0, 1).finished();
  for (std::size_t g = 0; g < table.weight.size(); ++g) {
    const int begin = table.start[g], count = table.start[g + 1] - begin;
    Eigen::MatrixX3d basis(count, 3);
    MatrixX2d b(count, 2);
    for (int a = 0; a < count; ++a) {
      const Vec2 r = mesh.nodes[table.node[begin + a]] - mesh.nodes[table.node[begin]];
      basis.row(a) << 1, r.x(), r.y();
      b.row(a) = table.gradient[begin + a].transpose();
    }
    const Eigen::Matrix3d normal = basis.transpose() * basis;
    const MatrixX2d change = basis * normal.ldlt().solve(wanted - basis.transpose() * b);
    for (int a = 0; a < count; ++a) table.gradient[begin + a] += change.row(a).transpose();
  }
}

double incompleteness(const IntegrationTable& table, const FieldMesh& mesh) {
  double largest = 0;
  for (std::size_t g = 0; g < table.weight.size(); ++g) {
    Vec2 sum(0, 0);
    Eigen::Matrix2d gradient = -Eigen::Matrix2d::Identity();
    const Vec2 origin = mesh.nodes[table.node[table.start[g]]];  // near the point, as far away rounding alone is 1e-12
    for (int e = table.start[g]; e < table.start[g + 1]; ++e) {
      sum += table.gradient[e];
      gradient += table.gradient[e] * (mesh.nodes[table.node[e]] - origin).transpose();
    }
    largest = std::max({largest, sum.cwiseAbs().maxCoeff(), gradient.cwiseAbs().maxCoeff()});
  }
  return largest;
}

}  // namespace

Points tributary_vectors(const FieldMesh& mesh) {
  Points vectors;
  for (int k = 0, n = mesh.outline_count; k < n; ++k) {
    const Vec2 along = mesh.nodes[(k + 1) % n] - mesh.nodes[(k + n - 1) % n];
    vectors.emplace_back(along.y() / 2, -along.x() / 2);
  }
  return vectors;
}

Points boundary_moments(const FieldMesh& mesh, const ShapeRows& outline_rows) {
  Points moments(mesh.nodes.size(), Vec2(0, 0));
  const Points tributary = tributary_vectors(mesh);
  for (std::size_t k = 0; k < tributary.size(); ++k)
    for (int e = outline_rows.start[k]; e < outline_rows.start[k + 1]; ++e)
      moments[outline_rows.node[e]] += outline_rows.value[e] * tributary[k];
  return moments;
}

double consistency_residual(const IntegrationTable& table, const FieldMesh& mesh, const ShapeRows& outline_rows) {
  const MatrixX2d lacking = lacking_moments(table, boundary_moments(mesh, outline_rows));
  return std::max(lacking.cwiseAbs().maxCoeff(), incompleteness(table, mesh));
}

double make_gradients_consistent(IntegrationTable& table, const FieldMesh& mesh, const ShapeRows& outline_rows) {
  const Points moments = boundary_moments(mesh, outline_rows);
  const MultiplierSystem system(table, mesh);
  for (int step = 0; step < refinement_steps; ++step) system.correct(table, lacking_moments(table, moments));
  // The pinned nodes take up the rounding of the sums of (1) over all points.
  const double allowed =
      std::max(tolerance, std::numeric_limits<double>::epsilon() * static_cast<double>(mesh.nodes.size()));
  double residual = consistency_residual(table, mesh, outline_rows);
  if (residual > allowed) {
    restore_completeness(table, mesh);
    for (int step = 0; step < refinement_steps; ++step) system.correct(table, lacking_moments(table, moments));
    residual = consistency_residual(table, mesh, outline_rows);
  }
  if (!(residual <= allowed))
    throw InputError(
        fmt::format("discretisation: conditions of consistent gradients hold to {:.3g} only, allowed: {:.0e}; "
                    "change `support` or the number of nodes",
                    residual, allowed));
  return residual;
}

}  // namespace pliant
