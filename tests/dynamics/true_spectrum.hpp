#pragma once

#include <Eigen/Eigenvalues>
#include <vector>

#include "support/bench.hpp"

namespace pliant::dynamics_tests {

/// One moving degree of freedom of a bench.
struct Coordinate {
  double* position;
  double* force;
  double inverse_mass;  ///< lumped
};

inline std::vector<Coordinate> coordinates(Bench& bench, Dofs& force) {
  std::vector<Coordinate> all;
  const Model& model = bench.model;
  for (const Batch& batch : model.batches)
    for (int lane = 0; lane < batch.count; ++lane)
      for (int i = 0; i < 2 * model.shape_of(batch).nodes(); ++i) {
        const std::size_t at = batch.offset + static_cast<std::size_t>(i);
        all.push_back({reinterpret_cast<double*>(&bench.state.position.compliant[at]) + lane,
                       reinterpret_cast<double*>(&force.compliant[at]) + lane,
                       model.shape_of(batch).inverse_mass_at_unit_density[i / 2] * batch.inverse_density[lane]});
      }
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    for (std::size_t c = 0; c < 3; ++c)
      if (const RigidDof& dof = model.rigid_bodies[r].dof[c]; !dof.imposed())
        all.push_back({&bench.state.position.rigid[3 * r + c], &force.rigid[3 * r + c], dof.inverse_mass});
  return all;
}

/// Largest w^2 of M^-1 K, or W K, at the bench's state, K = - d force / d position by central differences of all
/// forces, 1/s2. The step is small against penetrations and large against rounding; contacts stay where they are when
/// they are not at their edge.
inline double largest_square_frequency(Bench& bench, double step = 1e-6) {
  Trial trial(bench.model);
  Dofs& force = trial.force;
  const std::vector<Coordinate> all = coordinates(bench, force);
  const auto n = static_cast<Eigen::Index>(all.size());
  Eigen::MatrixXd matrix(n, n);
  const auto forces_into = [&](Eigen::VectorXd& column) {
    bench.evaluate(trial);
    for (const Coordinate& c : all) *c.force *= c.inverse_mass;
    // C D^-1 f with corrected mass. Copied: coordinates point into `force`.
    const Dofs acceleration = material_velocity(bench.model, force);
    std::copy(acceleration.compliant.begin(), acceleration.compliant.end(), force.compliant.begin());
    for (Eigen::Index i = 0; i < n; ++i) column[i] = *all[i].force;
  };
  Eigen::VectorXd plus(n), minus(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const double here = *all[j].position;
    *all[j].position = here + step;
    forces_into(plus);
    *all[j].position = here - step;
    forces_into(minus);
    *all[j].position = here;
    matrix.col(j) = (minus - plus) / (2 * step);
  }
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().real().maxCoeff();
}

}  // namespace pliant::dynamics_tests
