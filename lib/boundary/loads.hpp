#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

/// Force that a history applies to one rigid degree of freedom at time t, N/m (0 for imposed and free ones).
double applied_load(const RigidDof& dof, double time);

/// Adds gravity at the nodes of one region to its batch's forces: [slots x 2].
void add_gravity(const Model& model, const Region& region, Lanes* forces);

/// Adds applied loads and gravity to a rigid body's force [x, y, moment].
void add_rigid_loads(const Model& model, const RigidBody& rigid, double time, double* force);

/// Where an imposed degree of freedom stands after [t, t + dt], from its position at t: the exact integral of its velocity history.
double imposed_position(const RigidDof& dof, double position, double time, double dt);
double imposed_velocity(const RigidDof& dof, double time);

/// Work done on driven bodies over one accepted step, J/m: applied loads by the trapezoidal rule; an imposed motion does the change of
/// kinetic energy less the work of the other forces. Gravity is booked apart.
double external_work(const Model& model, const Dofs& position, const Dofs& next_position, const Dofs& velocity,
                     const Dofs& next_velocity, const Dofs& force, const Dofs& next_force, double time, double dt);

/// sum of m g . x over all bodies, J/m: the work of gravity is its growth.
double gravity_moment(const Model& model, const Dofs& position);

}  // namespace pliant
