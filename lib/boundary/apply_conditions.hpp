#pragma once

#include "bodies/model.hpp"

namespace pliant {

/// Applies a condition to a rigid degree of freedom of this mass; a pressure acts on `pressure_scale`, m.
void apply_axis_condition(RigidDof& dof, const AxisCondition& prescribed, double mass, double pressure_scale);

/// Applies boundary conditions (Scene::boundary) and the damping of materials to the bodies of a model that is complete
/// otherwise. Throws InputError for a part that contains no segment of the outline.
void apply_conditions(Model& model);

}  // namespace pliant
