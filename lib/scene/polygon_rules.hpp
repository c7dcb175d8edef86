#pragma once

#include <string>

#include "core/vec2.hpp"

namespace pliant {

/// Why a closed polygon cannot bound a body ("points 2 and 3 coincide", "edges 1 and 4 cross"); empty when it can.
/// Points and edges count from 1; edge i starts at point i. Time O(points^2).
std::string polygon_defect(const Points& polygon);

double signed_area(const Points& polygon);  ///< m2, positive for counter-clockwise

/// Largest distance of two points, m: the width of the body in its widest orientation.
double largest_extent(const Points& polygon);

}  // namespace pliant
