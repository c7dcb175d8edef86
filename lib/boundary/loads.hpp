#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline.hpp"

namespace pliant {

/// Force that a history applies to one rigid degree of freedom, N/m (0 for imposed and free ones). What a pressure
/// drives is held against its own weight in gravity g, m/s2 along it: contacts bear the pressure (docs/method.md 5).
double applied_load(const RigidDof& dof, const Instant& at, double g);

/// Adds gravity g, m/s2, at the nodes of one region to its batch's forces: [slots x 2].
void add_gravity(const Model& model, const Region& region, const Vec2& g, Lanes* forces);

/// Adds applied loads and gravity g to a rigid body's force [x, y, moment].
void add_rigid_loads(const RigidBody& rigid, const Vec2& g, const Instant& at, double* force);

/// Adds to the forces of a motion what loads change from its instant to another, on bodies that stand and move as they
/// do: of histories, and of what sets in or ends. Returns how much more supports' dashpots dissipate, W/m. So forces
/// need no new evaluation where only time goes on. `outlines`: that forces saw in this motion.
double add_load_change(const Model& model, const Motion& at, const Outlines& outlines, const Instant& to, Dofs& force);

/// Work done on driven bodies over one accepted step, J/m: applied loads by the trapezoidal rule; an imposed motion
/// does the change of kinetic energy less the work of the other forces. `force`: as the step began with, `next_force`:
/// as it ended with. Gravity is booked apart.
double external_work(const Model& model, const Motion& before, const Dofs& force, const Motion& after,
                     const Dofs& next_force);

/// sum of m g . x over all bodies, J/m: the work of a constant gravity is its growth.
double gravity_moment(const Model& model, const Vec2& g, const Dofs& position);
/// The same of each body of a batch; of a spread one, lanes add up to it.
Lanes gravity_moment(const Model& model, const Batch& batch, const Vec2& g, const Dofs& position);

/// Work of a gravity that has a history from one motion to a later one, J/m: trapezoidal rule. 0 for a constant one.
double gravity_work(const Model& model, const Motion& before, const Motion& after);

}  // namespace pliant
