#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

/// Damping of a rigid degree of freedom, force over velocity: of its material and of the dashpot beside its load, N
/// s/m2 (N s).
double damping_coefficient(const RigidDof& dof, const Instant& at);

/// Adds the mass damping of a rigid body to its forces on [x, y, angle].
void add_rigid_damping(const RigidBody& rigid, const Instant& at, const double* velocity, double* force);

/// Adds the forces that resist the velocity of each degree of freedom alone: mass-proportional damping, - c times the
/// momentum, and the dashpots beside the loads of rigid bodies. `velocity` as in a state (bodies/reciprocal_mass.hpp).
void add_mass_damping(const Model& model, const Instant& at, const Dofs& velocity, Dofs& force);

/// Whether some degree of freedom, or one of a body, has mass damping at some time.
bool has_mass_damping(const Model& model);
bool has_mass_damping(const Model& model, const Body& body);

}  // namespace pliant
