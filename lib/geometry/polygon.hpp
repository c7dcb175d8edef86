#pragma once

#include "core/vec2.hpp"

namespace pliant {

/// Length of a closed polygon, m.
double perimeter(const Points& polygon);

/// Whether x lies inside the closed polygon (even-odd rule; undecided on the outline itself).
bool is_inside(const Points& polygon, const Vec2& x);

/// Distance of x to the nearest point of the closed polygon, m; the polygon has no edge of length zero.
double distance_to_outline(const Points& polygon, const Vec2& x);

}  // namespace pliant
