#include "cli/shape_function.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "discretisation/basis.hpp"
#include "discretisation/table.hpp"
#include "geometry/mesh.hpp"

namespace pliant {
namespace {

/// Index of a triangle that holds x; -1: x is outside.
int triangle_at(const FieldMesh& mesh, const Vec2& x) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec2 &p = mesh.nodes[a], &q = mesh.nodes[b], &r = mesh.nodes[c];
    if (cross(q - p, x - p) >= 0 && cross(r - q, x - q) >= 0 && cross(p - r, x - r) >= 0) return static_cast<int>(t);
  }
  return -1;
}

std::string value_row(const Basis& basis, const Vec2& x, int triangle, int node) {
  const ShapeFunctions shape = basis(x, triangle);
  double value = 0;
  Vec2 gradient(0, 0);
  for (std::size_t a = 0; a < shape.node.size(); ++a)
    if (shape.node[a] == node) value = shape.value[a], gradient = shape.gradient[a];
  return fmt::format("value,{},{},{},{},{}\n", x.x(), x.y(), value, gradient.x(), gradient.y());
}

}  // namespace

std::string shape_function_csv(const ShapeFunctionRequest& request) {
  ShapeSpec disc;
  disc.name = "disc";
  disc.diameter = 2 * std::sqrt(request.nodes / std::numbers::pi);
  disc.nodes = request.nodes;
  const FieldMesh mesh = make_field_mesh(disc);
  const Basis basis = make_basis(mesh, request.settings);
  const auto nearer = [](const Vec2& a, const Vec2& b) { return a.squaredNorm() < b.squaredNorm(); };
  const int node =
      static_cast<int>(std::min_element(mesh.nodes.begin(), mesh.nodes.end(), nearer) - mesh.nodes.begin());
  std::string text = "kind,x,y,phi,phi_x,phi_y\n";
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    text += fmt::format("node,{},{},{},,\n", mesh.nodes[i].x(), mesh.nodes[i].y(), static_cast<int>(i) == node ? 1 : 0);
  const double half = disc.diameter / 2, step = disc.diameter / (request.grid - 1);
  for (int row = 0; row < request.grid; ++row)
    for (int column = 0; column < request.grid; ++column) {
      const Vec2 x(column * step - half, row * step - half);
      if (const int triangle = triangle_at(mesh, x); triangle >= 0) text += value_row(basis, x, triangle, node);
    }
  return text;
}

}  // namespace pliant
