#pragma once

#include "scene/scene.hpp"

namespace pliant {

/// Number of field nodes of a shape with a given outline: `nodes`, or the number for an isotropic mesh of the given
/// `spacing`. Throws InputError if it leaves no node for the interior.
int field_node_count(const ShapeSpec& shape, const Points& outline);

}  // namespace pliant
