#pragma once

#include "core/vec2.hpp"
#include "geometry/polygon_rules.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Reference geometry of one shape, coordinates relative to the centroid of its polygon.
struct FieldMesh {
  Points nodes;                     ///< [nodes], the outline first, counter-clockwise
  int outline_count = 0;            ///< the first outline_count nodes are the outline
  std::vector<Triangle> triangles;  ///< counter-clockwise, cover the polygon
};

/// Outline of a shape: counter-clockwise closed polygon about its centroid; a disc's polygon has the area of the
/// circle.
Points make_outline(const ShapeSpec& shape);

/// Outline and relaxed interior nodes, constrained Delaunay triangulation. Throws InputError (self-intersection, too
/// few nodes).
FieldMesh make_field_mesh(const ShapeSpec& shape);

/// Outline alone, triangulated without interior nodes (rigid bodies, for pictures only).
FieldMesh make_rigid_mesh(const ShapeSpec& shape);

/// Centres of a packing's grains, row by row. Throws InputError if it does not fit the period.
Points packing_positions(const Packing& packing, const std::optional<double>& period);

/// Open polyline of a wall over exactly one period, without the end point (the first, shifted). It is ordered so that
/// the outward normal (ty, -tx) points to the grains: right to left for a wall that is solid below, left to right for
/// one above. `spacing` is the largest segment length.
Points wall_outline(const Wall& wall, double period, double spacing);

}  // namespace pliant
