#pragma once

#include "bodies/dofs.hpp"
#include "bodies/point_law.hpp"
#include "materials/tensor.hpp"

namespace pliant {

/// Adds the internal forces of one batch's bodies, f_i = - sum_g w_g P_g b_gi (docs/method.md 2), [slots x 2] of the
/// batch. For a nodewise body all lanes have the least Jacobian, and lane 0 has power and loss.
PointTotals add_internal_forces(const Model& model, const Batch& batch, const BatchMotion& motion, Lanes* forces);

/// Strain energy of each body of a batch, J/m; padding lanes give 0, as do all but lane 0 of a nodewise body.
Lanes strain_energy(const Model& model, const Batch& batch, const BatchMotion& motion);

/// Deformation gradients at all integration points, [points] of one body (a lane of a batch).
std::vector<Tensor<double>> deformation_gradients(const Model& model, const Body& body, const Dofs& position);

}  // namespace pliant
