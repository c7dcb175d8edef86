#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline.hpp"

namespace pliant {

/// Throws InputError when a body starts deeper inside another than contact can see, a segment length of that other: it would be let through
/// without a force.
void refuse_deep_overlap(const Model& model, const Outlines& outlines);

}  // namespace pliant
