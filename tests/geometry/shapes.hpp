#pragma once

#include "geometry/curves.hpp"
#include "geometry/mesh.hpp"

/// Shapes that the tests of geometry and discretisation share.
namespace pliant::testing {

inline ShapeSpec disc(int nodes, double diameter = 1e-6) {
  ShapeSpec shape;
  shape.name = "disc";
  shape.diameter = diameter;
  shape.nodes = nodes;
  return shape;
}

inline ShapeSpec polygon(const char* name, const Points& points, int nodes) {
  ShapeSpec shape;
  shape.name = name;
  shape.kind = ShapeKind::polygon;
  shape.points = points;
  shape.nodes = nodes;
  return shape;
}

inline ShapeSpec square(int nodes) { return polygon("square", {{1, 1}, {3, 1}, {3, 3}, {1, 3}}, nodes); }

inline ShapeSpec l_shape(int nodes) {
  return polygon("L", {{0, 0}, {2e-3, 0}, {2e-3, 1e-3}, {1e-3, 1e-3}, {1e-3, 2e-3}, {0, 2e-3}}, nodes);
}

/// Two prongs of length 6 on a foot of 2 by 5, with a gap between: by default half a unit, less than the supports of
/// 180 nodes reach.
inline ShapeSpec fork(int nodes, double gap = 0.5) {
  const double left = 2.5 - gap / 2, right = 2.5 + gap / 2;
  return polygon("fork", {{0, 0}, {5, 0}, {5, 8}, {right, 8}, {right, 2}, {left, 2}, {left, 8}, {0, 8}}, nodes);
}

inline ShapeSpec curve(const char* name, const Points& points, int nodes) {
  ShapeSpec shape = polygon(name, points, nodes);
  shape.kind = ShapeKind::curve;
  return shape;
}

inline std::vector<ShapeSpec> all_shapes() {
  return {disc(168), square(150), l_shape(250), fork(180),
          curve("fourier", fourier_grain(1, {0.15, 0.1, 0.05}, 3), 168)};
}

inline Points outline_of(const FieldMesh& mesh) {
  return {mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count};
}

inline double triangle_area(const FieldMesh& mesh, const Triangle& t) {
  return cross(mesh.nodes[t[1]] - mesh.nodes[t[0]], mesh.nodes[t[2]] - mesh.nodes[t[0]]) / 2;
}

/// The message of the InputError that `action` throws; empty when it throws none.
template <class Action>
std::string error_of(Action&& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

}  // namespace pliant::testing
