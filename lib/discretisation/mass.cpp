#include "discretisation/mass.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <map>
#include <numeric>

#include "core/errors.hpp"
#include "discretisation/quadrature.hpp"

namespace pliant {

std::vector<double> lumped_mass(const FieldMesh& mesh, const Basis& basis) {
  const MeshQuadrature quadrature = mesh_quadrature(mesh, 6);
  std::vector<double> mass(mesh.nodes.size(), 0);
  for (std::size_t g = 0; g < quadrature.weight.size(); ++g) {
    const ShapeFunctions shape = basis(quadrature.position[g], quadrature.triangle[g]);
    for (std::size_t a = 0; a < shape.node.size(); ++a) mass[shape.node[a]] += quadrature.weight[g] * shape.value[a];
  }
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (!(mass[i] > 0))
      throw InputError(
          fmt::format("discretisation: lumped mass {:.3g} (in squared node distances) of node {}; it must be "
                      "positive: change `support` or the number of nodes",
                      mass[i], i));
  return mass;
}

double scale_outline_mass(int outline_count, double times, std::vector<double>& mass) {
  const double before = std::accumulate(mass.begin(), mass.end(), 0.0);
  for (int i = 0; i < outline_count; ++i) mass[i] *= times;
  return before / std::accumulate(mass.begin(), mass.end(), 0.0);
}

ShapeRows mass_correction(const FieldMesh& mesh, const Basis& basis, const std::vector<double>& lumped) {
  const MeshQuadrature quadrature = mesh_quadrature(mesh, 6);
  std::vector<std::map<int, double>> mass(lumped.size());
  for (std::size_t g = 0; g < quadrature.weight.size(); ++g) {
    const ShapeFunctions shape = basis(quadrature.position[g], quadrature.triangle[g]);
    for (std::size_t a = 0; a < shape.node.size(); ++a)
      for (std::size_t b = 0; b < shape.node.size(); ++b)
        mass[shape.node[a]][shape.node[b]] += quadrature.weight[g] * shape.value[a] * shape.value[b];
  }
  ShapeRows rows;
  rows.start.push_back(0);
  for (std::size_t i = 0; i < mass.size(); ++i) {
    for (const auto& [j, m] : mass[i]) {
      rows.node.push_back(j);
      rows.value.push_back((static_cast<std::size_t>(j) == i ? 2.0 : 0.0) - m / lumped[i]);
    }
    rows.start.push_back(static_cast<int>(rows.node.size()));
  }
  return rows;
}

double correction_bound(const ShapeRows& correction, const std::vector<double>& lumped) {
  constexpr std::size_t most_nodes = 1000;  // a dense eigenvalue problem of this size takes a tenth of a second
  const std::size_t n = lumped.size();
  if (n > most_nodes) return 2;
  Eigen::MatrixXd symmetric = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i)
    for (int e = correction.start[i]; e < correction.start[i + 1]; ++e) {
      const int j = correction.node[e];
      symmetric(static_cast<Eigen::Index>(i), j) = correction.value[e] * std::sqrt(lumped[i] / lumped[j]);
    }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

double inertia_ratio(const FieldMesh& mesh, const std::vector<double>& lumped, const ShapeRows& correction) {
  const Eigen::Index n = static_cast<Eigen::Index>(lumped.size());
  const Eigen::Map<const Eigen::VectorXd> mass(lumped.data(), n);
  Eigen::MatrixX2d velocity(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) velocity.row(i) << -mesh.nodes[i].y(), mesh.nodes[i].x();
  Eigen::MatrixX2d y = velocity;
  if (!correction.start.empty()) {
    Eigen::SparseMatrix<double> matrix(n, n);  // D C = 2 D - M
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i)
      for (int e = correction.start[i]; e < correction.start[i + 1]; ++e)
        entries.emplace_back(i, correction.node[e], lumped[i] * correction.value[e]);
    matrix.setFromTriplets(entries.begin(), entries.end());
    y = Eigen::ConjugateGradient < Eigen::SparseMatrix<double>,
    Eigen::Lower | Eigen::Upper > (matrix).solve(mass.asDiagonal() * velocity);
  }
  const Points outline(mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count);
  return mass.dot(velocity.cwiseProduct(y).rowwise().sum()) / polygon_properties(outline).polar_moment;
}

}  // namespace pliant
