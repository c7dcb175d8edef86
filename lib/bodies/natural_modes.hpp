#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodies/model.hpp"

namespace pliant {

/// Small motions of a compliant body about its start, with nothing that touches, loads, supports or damps it. Vectors
/// of a body, [2 nodes], hold x and y of node 0, of node 1 and so on: those of its degrees of freedom.
struct SmallMotions {
  Eigen::MatrixXd stiffness;     ///< [2 nodes x 2 nodes], Pa; symmetric
  Eigen::MatrixXd inverse_mass;  ///< [nodes x nodes], of x as of y, m/kg; symmetric
};

/// Most nodes of a body that natural_modes takes: its matrices are dense, some 150 MB at that.
inline constexpr int most_modal_nodes = 1500;

/// Stiffness from central differences of the internal forces, of fourth order in the step (relative error some 1e-11),
/// and mass from the velocities that momenta give: the kernels of a run. Only for models without spread or related
/// bodies. Throws InputError for more than most_modal_nodes.
SmallMotions small_motions(const Model& model, const Body& body);

/// Natural frequencies of a body, growing.
struct NaturalModes {
  int motions_at_rest = 0;        ///< without stiffness: 3 of a rigid body; more are mechanisms
  std::vector<double> frequency;  ///< of the others, angular, rad/s
};

/// All of them: frequencies w, w^2 the eigenvalues of inverse mass times stiffness. Those under 1e-4 of the largest w
/// are at rest.
NaturalModes natural_modes(const SmallMotions& motions);

}  // namespace pliant
