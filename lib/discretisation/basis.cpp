#include "discretisation/basis.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// Values below this are rounding of functions that vanish at other nodes.
constexpr double nothing = 1e-13;

std::vector<int> triangle_at_node(const FieldMesh& mesh) {
  std::vector<int> result(mesh.nodes.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int node : mesh.triangles[t]) result[node] = static_cast<int>(t);
  return result;
}

}  // namespace

Basis linear_triangles(const FieldMesh& mesh) {
  return [&mesh](const Vec2& x, int triangle) {
    const Triangle& t = mesh.triangles[triangle];
    ShapeFunctions shape;
    const double twice_area = cross(mesh.nodes[t[1]] - mesh.nodes[t[0]], mesh.nodes[t[2]] - mesh.nodes[t[0]]);
    for (int corner = 0; corner < 3; ++corner) {
      const Vec2 &a = mesh.nodes[t[(corner + 1) % 3]], &b = mesh.nodes[t[(corner + 2) % 3]];
      shape.node.push_back(t[corner]);
      shape.value.push_back(cross(a - x, b - x) / twice_area);
      shape.gradient.push_back(Vec2(a.y() - b.y(), b.x() - a.x()) / twice_area);
    }
    return shape;
  };
}

Basis watched(const Basis& basis, BasisQuality& quality) {
  return [basis, &quality](const Vec2& x, int triangle) {
    ShapeFunctions shape = basis(x, triangle);
    const double least = *std::min_element(shape.value.begin(), shape.value.end());
    if (least < -nothing) quality.least_value = std::min(quality.least_value, least);
    quality.condition = std::max(quality.condition, shape.condition);
    return shape;
  };
}

ShapeRows rows_at_nodes(const FieldMesh& mesh, const Basis& basis) {
  const std::vector<int> triangle = triangle_at_node(mesh);
  ShapeRows rows;
  rows.start.push_back(0);
  for (std::size_t k = 0; k < mesh.nodes.size(); ++k) {
    const ShapeFunctions shape = basis(mesh.nodes[k], triangle[k]);
    for (std::size_t a = 0; a < shape.node.size(); ++a) {
      if (std::abs(shape.value[a]) < nothing) continue;
      rows.node.push_back(shape.node[a]);
      rows.value.push_back(shape.value[a]);
    }
    rows.start.push_back(static_cast<int>(rows.node.size()));
  }
  return rows;
}

ShapeRows rows_at_outline(const FieldMesh& mesh, const ShapeRows& node_rows) {
  ShapeRows rows;
  rows.start.assign(node_rows.start.begin(), node_rows.start.begin() + mesh.outline_count + 1);
  rows.node.assign(node_rows.node.begin(), node_rows.node.begin() + rows.start.back());
  rows.value.assign(node_rows.value.begin(), node_rows.value.begin() + rows.start.back());
  return rows;
}

}  // namespace pliant
