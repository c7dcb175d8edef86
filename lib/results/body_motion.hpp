#pragma once

#include "results/snapshot.hpp"

namespace pliant {

/// Centre of mass, m.
Vec2 centre_of(const Model& model, const Body& body, const Dofs& position);
/// Mean of velocities or accelerations over the mass of a body.
Vec2 mean_rate(const Model& model, const Body& body, const Dofs& rates);
/// x, y, angle of a rigid body in a quantity.
const double* rigid_values(const Body& body, const Dofs& dofs);

/// Where a reference point of a body's shape was put at the start, from the body's fixed centre.
Vec2 arm_at_start(const Body& body, const Vec2& reference);

// Fields at the points of a body's shape, [reference points]: those of a compliant body must be its field nodes.
Points positions_at(const Snapshot& snapshot, const Body& body, const Points& reference);
Points displacements_at(const Snapshot& snapshot, const Body& body, const Points& reference);
Points velocities_at(const Snapshot& snapshot, const Body& body, const Points& reference);
Points accelerations_at(const Snapshot& snapshot, const Body& body, const Points& reference);

}  // namespace pliant
