#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline.hpp"

namespace pliant {

/// Empty outlines of all bodies of a model, at their offsets.
Outlines make_outlines(const Model& model);

/// Moves all outlines to where the bodies are: phi rows for compliant bodies, rotation for rigid ones.
void update_outlines(const Model& model, const Dofs& positions, Outlines& outlines);

/// Carries the contact forces on the outline nodes of a batch's bodies to the degrees of freedom of one of its regions:
/// forces, [slots x 2] of the batch, += phi^T f.
void add_outline_forces(const Model& model, const Region& region, const Outlines& outlines, Lanes* forces);

/// Contact force and moment on a rigid body: [x, y, moment about its centre].
void outline_force_resultant(const Model& model, const RigidBody& rigid, const Outlines& outlines,
                             const double* position, double* resultant);

/// Fills the outline nodes' velocities; does nothing in a model without outline_rates. After update_outlines of the same motion.
void update_outline_velocities(const Model& model, const Motion& motion, Outlines& outlines);

}  // namespace pliant
