#pragma once

#include "scene/scene.hpp"

namespace pliant {

/// Number of field nodes of a shape whose outline is given: `nodes`, or what an isotropic mesh of the given `spacing`
/// needs. Throws InputError when it leaves no node for the interior.
int field_node_count(const ShapeSpec& shape, const Points& outline);

}  // namespace pliant
