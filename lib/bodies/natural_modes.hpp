#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodies/model.hpp"

namespace pliant {

/// Linearised motion of a compliant body about its start, without contact, loads, supports or damping. Vectors of a
/// body, [2 nodes], hold x and y of node 0, of node 1 and so on: those of its degrees of freedom.
struct SmallMotions {
  Eigen::MatrixXd stiffness;     ///< [2 nodes x 2 nodes], Pa; symmetric
  Eigen::MatrixXd inverse_mass;  ///< [nodes x nodes], for x as for y, m/kg; symmetric
};

/// Largest number of nodes for natural_modes, whose matrices are dense, some 150 MB at that size.
inline constexpr int most_modal_nodes = 1500;

/// Stiffness from central differences of the internal forces, of fourth order in the step (relative error some 1e-11),
/// and mass from the velocities of unit momenta: by the kernels of a run. Only for models without nodewise or
/// same-topology bodies. Throws InputError for more than most_modal_nodes.
SmallMotions small_motions(const Model& model, const Body& body);

/// Natural frequencies of a body, ascending.
struct NaturalModes {
  int motions_at_rest = 0;        ///< modes without stiffness: 3 rigid ones; more are mechanisms
  std::vector<double> frequency;  ///< of the others, angular, rad/s
};

/// All natural frequencies w, with w^2 the eigenvalues of inverse mass times stiffness. Those under 1e-4 of the largest
/// count as zero.
NaturalModes natural_modes(const SmallMotions& motions);

}  // namespace pliant
