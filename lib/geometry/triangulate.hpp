#pragma once

#include "core/vec2.hpp"

namespace pliant {

/// Constrained Delaunay triangulation (CGAL) of the inside of a polygon. The first outline_count points are its
/// outline, counter-clockwise; the others are inside. Triangles are counter-clockwise, have positive area, and cover
/// the polygon. Throws InputError if two points coincide, a point is on the outline, or the outline crosses itself.
std::vector<Triangle> triangulate_inside(const Points& points, int outline_count);

}  // namespace pliant
