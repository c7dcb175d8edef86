#pragma once

#include "core/vec2.hpp"

namespace pliant {

/// Whether two closed polygons share a point: some edges meet, or one is inside the other. Time O(corners^2).
bool polygons_overlap(const Points& a, const Points& b);

}  // namespace pliant
