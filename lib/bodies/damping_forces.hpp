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

/// Adds - mass_damping m v in a region. Returns what it dissipates, W/m.
double add_mass_damping(const Model& model, const Region& region, const Lanes* velocities, Lanes* forces);

/// Damping of a rigid body: - (damping + mass_damping m) v on [x, y, angle].
double add_rigid_damping(const RigidBody& rigid, double time, const double* velocity, double* force);

/// The largest rate of a rigid body's dashpots, damping / mass, 1/s.
double damping_rate(const RigidBody& rigid);

}  // namespace pliant
