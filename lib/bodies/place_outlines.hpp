#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"

namespace pliant {

/// Sets the cyclic copies of an outline's nodes in a field of positions; x, y: [count + lane_count].
void extend_cyclically(const OutlineShape& shape, double* x, double* y);

/// Computes the positions of a rigid body's outline from its own, [x, y, angle].
void place_rigid_outline(const Model& model, const RigidBody& rigid, const double* position, OutlineField& outlines);

/// Computes the positions of the outlines of own bodies: by phi rows for compliant bodies, by rotation for rigid ones.
void place_outlines(const Model& model, const Dofs& positions, OutlineField& position);

/// Computes a field without origin, such as velocities, at the outline nodes of own compliant bodies; those of rigid
/// bodies are not changed.
void update_outline_field(const Model& model, const Dofs& values, OutlineField& field);

/// Positions of the outlines of all bodies, in a new field.
OutlineField placed_outlines(const Model& model, const Dofs& positions);

/// Updates the outlines of own bodies in a motion: positions, and velocities and current lengths in models that need
/// them.
void update_outlines(const Model& model, const Motion& motion, Outlines& outlines);

/// Transfers forces on the outline nodes of a batch's bodies to the degrees of freedom of one of its regions: forces,
/// [slots x 2] of the batch, += phi^T f.
void add_outline_forces(const Model& model, const Region& region, const OutlineField& on_outlines, Lanes* forces);

/// Force and moment of the forces on a rigid body's outline: [x, y, moment about its centre].
void outline_force_resultant(const Model& model, const RigidBody& rigid, const OutlineField& outlines,
                             const OutlineField& on_outlines, const double* position, double* resultant);

}  // namespace pliant
