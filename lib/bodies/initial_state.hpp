#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

Dofs zero_dofs(const Model& model);

/// Copies the last body of each batch into the padding lanes.
void fill_padding(const Model& model, Dofs& dofs);

/// Initial positions: reference shapes, rotated by each body's angle. Compliant positions are relative to the batch's
/// centres, in units of the body's scale.
Dofs initial_positions(const Model& model);

/// Sets velocities that conditions impose at t = 0; others stay as they are. [3 rigid bodies]
void set_imposed_velocities(const Model& model, Dofs& velocities);

/// Uniform, rotational and linear initial velocity fields of the scene, and the imposed ones of driven walls at t = 0.
Dofs initial_velocities(const Model& model, const Dofs& positions);

}  // namespace pliant
