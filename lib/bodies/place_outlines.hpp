#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline.hpp"

namespace pliant {

/// Where all outlines are: phi rows for compliant bodies, rotation for rigid ones.
void place_outlines(const Model& model, const Dofs& positions, OutlineField& position);

/// Values of a field at all outline nodes, of rigid bodies left as they are: velocities of compliant ones.
void update_outline_field(const Model& model, const Dofs& values, OutlineField& field);

/// Where all outlines are, newly made.
OutlineField placed_outlines(const Model& model, const Dofs& positions);

/// All that a motion shows: positions, and velocities and present lengths in models that need them.
void update_outlines(const Model& model, const Motion& motion, Outlines& outlines);

/// Carries forces on the outline nodes of a batch's bodies to the degrees of freedom of one of its regions: forces,
/// [slots x 2] of the batch, += phi^T f.
void add_outline_forces(const Model& model, const Region& region, const OutlineField& on_outlines, Lanes* forces);

/// Force and moment of the forces on a rigid body's outline: [x, y, moment about its centre].
void outline_force_resultant(const Model& model, const RigidBody& rigid, const OutlineField& outlines,
                             const OutlineField& on_outlines, const double* position, double* resultant);

}  // namespace pliant
