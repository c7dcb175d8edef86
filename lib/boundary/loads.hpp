#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"

namespace pliant {

/// Force that a history applies to one rigid degree of freedom, N/m (0 for imposed and free ones). A body that a
/// a prescribed pressure is held against its own weight in gravity g, m/s2 along it: contacts bear the pressure
/// (docs/method.md 5).
double applied_load(const RigidDof& dof, const Instant& at, double g);

/// Adds gravity g, m/s2, at the nodes of one region to its batch's forces: [slots x 2].
void add_gravity(const Model& model, const Region& region, const Vec2& g, Lanes* forces);

/// Adds applied loads and gravity g to a rigid body's force [x, y, moment].
void add_rigid_loads(const RigidBody& rigid, const Vec2& g, const Instant& at, double* force);

/// Adds the change of loads from the instant of a motion to another, on bodies that keep their positions and
/// velocities: changes of histories, and conditions that begin or end. Returns the increase of the power of supports'
/// dashpots, W/m. Thus forces need no new evaluation if only time advances. `outlines`: those that forces used in this
/// motion.
double add_load_change(const Model& model, const Motion& at, const Outlines& outlines, const Instant& to, Dofs& force);

/// Work on driven bodies in one accepted step, J/m: applied loads by the trapezoidal rule; an imposed motion does the
/// change of kinetic energy less the work of the other forces. `force`: at the start of the step, `next_force`: at its
/// end. Gravity is counted separately.
double external_work(const Model& model, const Motion& before, const Dofs& force, const Motion& after,
                     const Dofs& next_force);

/// Sum of m g . x over all bodies, J/m: its increase is the work of a constant gravity.
double gravity_moment(const Model& model, const Vec2& g, const Dofs& position);
/// The same for each body of a batch; for a nodewise body the lanes add up to it.
Lanes gravity_moment(const Model& model, const Batch& batch, const Vec2& g, const Dofs& position);

/// Work of gravity with a history from one motion to a later one, J/m: trapezoidal rule. 0 for constant gravity.
double gravity_work(const Model& model, const Motion& before, const Motion& after);

}  // namespace pliant
