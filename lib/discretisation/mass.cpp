#include "discretisation/mass.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <cmath>
#include <limits>
#include <map>
#include <set>

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

namespace {

/// [outline nodes] ascending inner nodes that share an edge of the triangulation, which lies within the body.
std::vector<std::set<int>> inner_neighbours(const FieldMesh& mesh) {
  std::vector<std::set<int>> neighbours(static_cast<std::size_t>(mesh.outline_count));
  for (const Triangle& triangle : mesh.triangles)
    for (const int o : triangle)
      for (const int i : triangle)
        if (o < mesh.outline_count && i >= mesh.outline_count) neighbours[o].insert(i);
  return neighbours;
}

/// [nodes] outline nodes to which each inner node is the nearest across an edge; of nodes that are equally near to
/// rounding the first.
std::vector<std::vector<int>> nearest_outline_nodes(const FieldMesh& mesh) {
  constexpr double rounding = 1e-9;
  std::vector<std::vector<int>> of_inner(mesh.nodes.size());
  const std::vector<std::set<int>> neighbours = inner_neighbours(mesh);
  for (int o = 0; o < mesh.outline_count; ++o) {
    double least = std::numeric_limits<double>::infinity();
    int nearest = -1;
    for (const int i : neighbours[o])
      if (const double d = (mesh.nodes[i] - mesh.nodes[o]).norm(); d < (1 - rounding) * least) least = d, nearest = i;
    if (nearest >= 0) of_inner[nearest].push_back(o);
  }
  return of_inner;
}

ShapeRows rows_of(const std::vector<std::map<int, double>>& matrix) {
  ShapeRows rows;
  rows.start.push_back(0);
  for (const auto& row : matrix) {
    for (const auto& [j, value] : row) rows.node.push_back(j), rows.value.push_back(value);
    rows.start.push_back(static_cast<int>(rows.node.size()));
  }
  return rows;
}

}  // namespace

ScaledMass scaled_mass(const FieldMesh& mesh, const std::vector<double>& lumped, double scaling) {
  std::vector<std::map<int, double>> reciprocal(lumped.size());
  for (std::size_t i = 0; i < lumped.size(); ++i) reciprocal[i][static_cast<int>(i)] = 1;
  std::vector<std::map<int, double>> relative = reciprocal;
  const std::vector<std::vector<int>> outline_nodes = nearest_outline_nodes(mesh);
  for (std::size_t i = static_cast<std::size_t>(mesh.outline_count); i < lumped.size(); ++i) {
    std::vector<int> node{static_cast<int>(i)};  // an inner node and the outline nodes that it is coupled to
    node.insert(node.end(), outline_nodes[i].begin(), outline_nodes[i].end());
    const Eigen::Index size = static_cast<Eigen::Index>(node.size());
    Eigen::VectorXd diagonal(size);
    for (Eigen::Index a = 0; a < size; ++a) diagonal[a] = lumped[node[a]];
    Eigen::MatrixXd mass = diagonal.asDiagonal();
    for (Eigen::Index a = 1; a < size; ++a) {
      const double coupling = (scaling - 1) * diagonal[a];
      mass(a, a) += coupling, mass(0, 0) += coupling, mass(a, 0) -= coupling, mass(0, a) -= coupling;
    }
    const Eigen::MatrixXd c = mass.ldlt().solve(Eigen::MatrixXd(diagonal.asDiagonal()));
    for (Eigen::Index a = 0; a < size; ++a)
      for (Eigen::Index b = 0; b < size; ++b) {
        reciprocal[node[a]][node[b]] = c(a, b);
        relative[node[a]][node[b]] = mass(a, b) / diagonal[a];
      }
  }
  return {rows_of(reciprocal), rows_of(relative)};
}

ShapeRows corrected_reciprocal_mass(const FieldMesh& mesh, const Basis& basis, const std::vector<double>& lumped) {
  const MeshQuadrature quadrature = mesh_quadrature(mesh, 6);
  std::vector<std::map<int, double>> mass(lumped.size());
  for (std::size_t g = 0; g < quadrature.weight.size(); ++g) {
    const ShapeFunctions shape = basis(quadrature.position[g], quadrature.triangle[g]);
    for (std::size_t a = 0; a < shape.node.size(); ++a)
      for (std::size_t b = 0; b < shape.node.size(); ++b)
        mass[shape.node[a]][shape.node[b]] += quadrature.weight[g] * shape.value[a] * shape.value[b];
  }
  for (std::size_t i = 0; i < mass.size(); ++i)
    for (auto& [j, m] : mass[i]) m = (static_cast<std::size_t>(j) == i ? 2.0 : 0.0) - m / lumped[i];
  return rows_of(mass);
}

double reciprocal_mass_bound(const ShapeRows& reciprocal_mass, const std::vector<double>& lumped) {
  constexpr std::size_t most_nodes = 1000;  // a dense eigenvalue problem of this size takes a tenth of a second
  const std::size_t n = lumped.size();
  if (n > most_nodes) return 2;
  Eigen::MatrixXd symmetric = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i)
    for (int e = reciprocal_mass.start[i]; e < reciprocal_mass.start[i + 1]; ++e) {
      const int j = reciprocal_mass.node[e];
      symmetric(static_cast<Eigen::Index>(i), j) = reciprocal_mass.value[e] * std::sqrt(lumped[i] / lumped[j]);
    }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

namespace {

/// Twice the kinetic energy y.D C y / 2 of these velocities C y at density 1.
double twice_kinetic_energy(const std::vector<double>& lumped, const ShapeRows& reciprocal_mass,
                            const Eigen::MatrixX2d& velocity) {
  const Eigen::Index n = static_cast<Eigen::Index>(lumped.size());
  const Eigen::Map<const Eigen::VectorXd> mass(lumped.data(), n);
  Eigen::MatrixX2d y = velocity;
  if (!reciprocal_mass.start.empty()) {
    Eigen::SparseMatrix<double> matrix(n, n);  // D C
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i)
      for (int e = reciprocal_mass.start[i]; e < reciprocal_mass.start[i + 1]; ++e)
        entries.emplace_back(i, reciprocal_mass.node[e], lumped[i] * reciprocal_mass.value[e]);
    matrix.setFromTriplets(entries.begin(), entries.end());
    y = Eigen::ConjugateGradient < Eigen::SparseMatrix<double>,
    Eigen::Lower | Eigen::Upper > (matrix).solve(mass.asDiagonal() * velocity);
  }
  return mass.dot(velocity.cwiseProduct(y).rowwise().sum());
}

/// Velocities of the nodes at x, y: components a x + b y.
Eigen::MatrixX2d linear_field(const FieldMesh& mesh, const Vec2& a, const Vec2& b) {
  Eigen::MatrixX2d velocity(static_cast<Eigen::Index>(mesh.nodes.size()), 2);
  for (Eigen::Index i = 0; i < velocity.rows(); ++i) velocity.row(i) = mesh.nodes[i].x() * a + mesh.nodes[i].y() * b;
  return velocity;
}

}  // namespace

double inertia_ratio(const FieldMesh& mesh, const std::vector<double>& lumped, const ShapeRows& reciprocal_mass) {
  const Points outline(mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count);
  return twice_kinetic_energy(lumped, reciprocal_mass, linear_field(mesh, {0, 1}, {-1, 0})) /
         polygon_properties(outline).polar_moment;
}

double stretching_ratio(const FieldMesh& mesh, const std::vector<double>& lumped, const ShapeRows& reciprocal_mass) {
  double largest = 0;
  for (const Eigen::MatrixX2d& velocity : {linear_field(mesh, {1, 0}, {0, -1}), linear_field(mesh, {0, 1}, {1, 0})})
    largest = std::max(
        largest, twice_kinetic_energy(lumped, reciprocal_mass, velocity) / twice_kinetic_energy(lumped, {}, velocity));
  return largest;
}

}  // namespace pliant
