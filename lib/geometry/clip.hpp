#pragma once

#include "core/vec2.hpp"

namespace pliant {

/// Part of a polygon inside a rectangle (Sutherland and Hodgman 1974, doi 10.1145/360767.360802). Its area is exact for
/// concave polygons too: separate parts stay joined by edges on the rectangle that run forth and back.
Points clipped(const Points& polygon, const Vec2& low, const Vec2& high);

}  // namespace pliant
