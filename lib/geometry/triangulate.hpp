#pragma once

#include "core/vec2.hpp"

namespace pliant {

/// Constrained Delaunay triangulation (CGAL) of the inside of a polygon: the first outline_count points are its
/// outline, counter-clockwise, the others lie inside. Triangles are counter-clockwise and of positive area, and cover
/// the polygon. Throws InputError when two points coincide, a point lies on the outline, or the outline crosses itself.
std::vector<Triangle> triangulate_inside(const Points& points, int outline_count);

}  // namespace pliant
