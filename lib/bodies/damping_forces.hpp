#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

/// Adds the Kelvin-Voigt forces of one batch, f_i = - sum_g w_g F_g S_g b_gi with the second Piola stress S = 2
/// viscosity E_dot (METHOD 3). E_dot = sym(F^T F_dot) vanishes in rigid motions. positions, velocities, forces:
/// [slots x 2] of the batch; linear in the velocities. Returns what each body dissipates, sum_g w_g 2 viscosity E_dot
/// : E_dot, W/m; padding lanes repeat a body.
Lanes add_viscous_forces(const Model& model, const Batch& batch, const Lanes* positions, const Lanes* velocities,
                         Lanes* forces);

/// The same for a batch that may have none. Returns the power of all bodies together.
double viscous_power(const Model& model, const Batch& batch, const Lanes* positions, const Lanes* velocities,
                     Lanes* forces);

/// Drag on a rigid degree of freedom, force over velocity: of its material and of the dashpot beside its load, N s/m2 (N s).
double drag_coefficient(const RigidDof& dof, const Instant& at);

/// Adds the drag of a rigid body to its forces on [x, y, angle].
void add_rigid_drag(const RigidBody& rigid, const Instant& at, const double* velocity, double* force);

/// Adds what resists the velocity of each degree of freedom by itself, no matter what others do: mass-proportional damping, - c times the momentum, and
/// the dashpots beside the loads of rigid bodies. `velocity` as a state holds it (bodies/mass_correction.hpp).
void add_drag(const Model& model, const Instant& at, const Dofs& velocity, Dofs& force);

/// Whether some degree of freedom, or one of a body, ever meets drag.
bool has_drag(const Model& model);
bool has_drag(const Model& model, const Body& body);

}  // namespace pliant
