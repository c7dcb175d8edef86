#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

/// With corrected or scaled mass a state holds y = p/D, momentum over lumped mass, in place of velocities. Positions
/// move by v = C y, where C D^-1 is the reciprocal mass matrix, and kinetic energy is y.D C y / 2 (docs/method.md 2).
/// Otherwise C = I, v = y.

/// v = C y of one batch, [slots x 2] each; y and v must be different arrays.
void apply_reciprocal_mass(const Model& model, const Batch& batch, const Lanes* y, Lanes* v);

/// y = C^-1 v of one batch with scaled mass, as above.
void apply_relative_mass(const Model& model, const Batch& batch, const Lanes* v, Lanes* y);

/// Velocities of all degrees of freedom from the reduced momenta of a state.
Dofs material_velocity(const Model& model, const Dofs& y);

/// The same without allocation: y itself with lumped mass, else `scratch`, which must be another array.
const Dofs& material_velocity(const Model& model, const Dofs& y, Dofs& scratch);

/// Reduced momenta y with these velocities.
Dofs reduced_momentum(const Model& model, const Dofs& velocity);

}  // namespace pliant
