#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "materials/tensor.hpp"

namespace pliant {

/// Adds the internal forces of one batch's bodies, f_i = - sum_g w_g P(F_g) b_gi (METHOD 2).
/// positions, forces: [slots x 2] of the batch. Returns the least Jacobian met, a lane a body (a spread body: in all).
Lanes add_internal_forces(const Model& model, const Batch& batch, const Lanes* positions, Lanes* forces);

/// Strain energy of each body of a batch, J/m; padding lanes give 0, as do all but lane 0 of a spread body.
Lanes strain_energy(const Model& model, const Batch& batch, const Lanes* positions);

/// Deformation gradients at all integration points, [points] of one body (a lane of a batch).
std::vector<Tensor<double>> deformation_gradients(const Model& model, const Body& body, const Dofs& position);

}  // namespace pliant
