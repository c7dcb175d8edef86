#pragma once

#include "bodies/model.hpp"

namespace pliant {

/// Lets a drive move a rigid degree of freedom of this mass; a pressure acts on `pressure_scale`, m.
void apply_drive(RigidDof& dof, const Drive& drive, double mass, double pressure_scale);

/// Gives the bodies of a model, complete otherwise, what acts on them from outside (Scene::boundary) and the damping
/// of their materials. Throws InputError for a part that no segment of the outline lies in.
void apply_conditions(Model& model);

}  // namespace pliant
