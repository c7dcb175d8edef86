#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

Dofs zero_dofs(const Model& model);

/// Padding lanes repeat the last body of their batch.
void fill_padding(const Model& model, Dofs& dofs);

/// Reference shapes, turned by each body's angle. Compliant positions are relative to the batch's centres, in units of
/// the body's scale.
Dofs initial_positions(const Model& model);

/// Of driven degrees of freedom at t = 0, where their motion is imposed; others stay as they are. [3 rigid bodies]
void set_imposed_velocities(const Model& model, Dofs& velocities);

/// Uniform, rotational and linear initial velocity fields of the scene, and the imposed ones of driven walls at t = 0.
Dofs initial_velocities(const Model& model, const Dofs& positions);

}  // namespace pliant
