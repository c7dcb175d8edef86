#include "bodies/natural_modes.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "bodies/initial_state.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "core/errors.hpp"

namespace pliant {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Step of the differences over the least distance of nodes. Truncation grows with its fourth power and rounding with
/// its inverse; both are some 1e-12 of a stiffness.
constexpr double difference_step = 1e-3;
/// Displacements in steps; four lanes compute one column.
constexpr double offsets[] = {1, -1, 2, -2};
constexpr int ways = 4, columns_at_once = lane_count / ways;
/// Zero modes by w over the largest w: first modes of finite elements have some 1e-2, differences leave some 1e-6.
constexpr double at_rest = 1e-4;

void check_size(const Model& model, const Body& body) {
  if (const int nodes = model.shape_of(body).nodes(); nodes > most_modal_nodes)
    throw InputError(fmt::format(
        "{}: natural frequencies of '{}': its shape has {} nodes, allowed: at most {}; ask for another with --body, or "
        "give its shape fewer 'nodes'",
        model.scene.file.string(), body.name, nodes, most_modal_nodes));
}

/// Batch with eight copies of this body.
Batch repeated(const Model& model, const Body& body) {
  Batch batch = model.batches[body.batch];
  for (Lanes& constant : batch.constants) constant = broadcast(constant[body.lane]);
  return batch;
}

/// Initial positions of this body in each lane, [2 nodes].
std::vector<Lanes> repeated_positions(const Model& model, const Body& body) {
  const Batch& batch = model.batches[body.batch];
  const Dofs q = initial_positions(model);
  std::vector<Lanes> result(2 * static_cast<std::size_t>(batch.slots));
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = broadcast(q.compliant[batch.offset + i][body.lane]);
  return result;
}

double least_distance(const CompliantShape& shape) {
  return *std::min_element(shape.space.nodal_distance.begin(), shape.space.nodal_distance.end());
}

/// Central differences of fourth order, times the step, of values at the four displacements. 0 where they are equal.
double slope(const double* f) { return (f[0] - f[1]) * 2 / 3 - (f[2] - f[3]) / 12; }

/// Forces, [2 nodes], of eight bodies whose degrees of freedom from `first` on are displaced one after the other, four
/// times each.
std::vector<Lanes> moved_forces(const Model& model, const Batch& batch, std::vector<Lanes> q, Index first, int columns,
                                double step) {
  for (int lane = 0; lane < columns * ways; ++lane)
    q[static_cast<std::size_t>(first + lane / ways)][lane] += step * offsets[lane % ways];
  std::vector<Lanes> force(q.size(), Lanes{});
  add_internal_forces(model, batch, {.position = q.data()}, force.data());
  return force;
}

MatrixXd stiffness_of(const Model& model, const Body& body) {
  const Batch batch = repeated(model, body);
  const std::vector<Lanes> q = repeated_positions(model, body);
  const auto size = static_cast<Index>(q.size());
  const double step = difference_step * least_distance(model.shape_of(body));
  MatrixXd stiffness(size, size);
  for (Index first = 0; first < size; first += columns_at_once) {
    const int columns = static_cast<int>(std::min<Index>(columns_at_once, size - first));
    const std::vector<Lanes> force = moved_forces(model, batch, q, first, columns, step);
    for (int c = 0; c < columns; ++c)
      for (Index i = 0; i < size; ++i)
        stiffness(i, first + c) =
            -slope(reinterpret_cast<const double*>(&force[static_cast<std::size_t>(i)]) + c * ways) / step;
  }
  return (stiffness + stiffness.transpose()) / 2;
}

/// Velocities by unit momenta at one node after the other: y = 1 / lumped mass there.
MatrixXd inverse_mass_of(const Model& model, const Body& body) {
  const Batch& batch = model.batches[body.batch];
  const CompliantShape& shape = model.shape_of(body);
  const Index nodes = shape.nodes();
  std::vector<Lanes> y(2 * static_cast<std::size_t>(batch.slots), Lanes{}), v = y;
  MatrixXd result(nodes, nodes);
  for (Index j = 0; j < nodes; ++j) {
    Lanes& unit = y[2 * static_cast<std::size_t>(j)];
    unit = broadcast(shape.inverse_mass_at_unit_density[static_cast<std::size_t>(j)] / batch.density[body.lane]);
    if (model.has_reciprocal_mass)
      apply_reciprocal_mass(model, batch, y.data(), v.data());
    else
      v = y;
    for (Index i = 0; i < nodes; ++i) result(i, j) = v[2 * static_cast<std::size_t>(i)][0];
    unit = Lanes{};
  }
  return (result + result.transpose()) / 2;
}

}  // namespace

SmallMotions small_motions(const Model& model, const Body& body) {
  check_size(model, body);
  return {stiffness_of(model, body), inverse_mass_of(model, body)};
}

/// With W = L L^T the eigenvalues of W K are those of L^T K L, which is symmetric.
NaturalModes natural_modes(const SmallMotions& motions) {
  const Index nodes = motions.inverse_mass.rows();
  const Eigen::LLT<MatrixXd> factors(motions.inverse_mass);
  if (factors.info() != Eigen::Success)
    throw InputError(
        "the mass is not positive definite: take mass = \"lumped\", or another `support` or number of nodes");
  const MatrixXd lower = factors.matrixL();
  MatrixXd scaled(2 * nodes, 2 * nodes);
  for (Index a = 0; a < 2; ++a)
    for (Index b = 0; b < 2; ++b) {
      const MatrixXd part = motions.stiffness(Eigen::seqN(a, nodes, 2), Eigen::seqN(b, nodes, 2));
      scaled.block(a * nodes, b * nodes, nodes, nodes) = lower.transpose() * part * lower;
    }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scaled, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& squares = solver.eigenvalues();
  NaturalModes modes;
  for (const double square : squares)
    if (square < at_rest * at_rest * squares[squares.size() - 1])
      ++modes.motions_at_rest;
    else
      modes.frequency.push_back(std::sqrt(square));
  return modes;
}

}  // namespace pliant
