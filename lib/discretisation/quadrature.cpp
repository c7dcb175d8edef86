#include "discretisation/quadrature.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.hpp"

namespace pliant {
namespace {

// Three points (1 - 2b, b, b) and their permutations.
void append_orbit(std::vector<QuadraturePoint>& rule, double b, double share) {
  const double a = 1 - 2 * b;
  rule.push_back({{a, b, b}, share});
  rule.push_back({{b, a, b}, share});
  rule.push_back({{b, b, a}, share});
}

std::vector<QuadraturePoint> one_point_rule() { return {{{1.0 / 3, 1.0 / 3, 1.0 / 3}, 1.0}}; }

std::vector<QuadraturePoint> three_point_rule() {
  std::vector<QuadraturePoint> rule;
  append_orbit(rule, 1.0 / 6, 1.0 / 3);
  return rule;
}

std::vector<QuadraturePoint> six_point_rule() {
  std::vector<QuadraturePoint> rule;
  const double root = std::sqrt(38 - 44 * std::sqrt(0.4)), weight_root = std::sqrt(213125 - 53320 * std::sqrt(10.0));
  append_orbit(rule, (8 - std::sqrt(10.0) + root) / 18, (620 + weight_root) / 3720);
  append_orbit(rule, (8 - std::sqrt(10.0) - root) / 18, (620 - weight_root) / 3720);
  return rule;
}

}  // namespace

const std::vector<QuadraturePoint>& triangle_rule(int points) {
  static const std::vector<QuadraturePoint> one = one_point_rule(), three = three_point_rule(), six = six_point_rule();
  if (points == 1) return one;
  if (points == 3) return three;
  if (points == 6) return six;
  throw InputError(fmt::format("discretisation: {} Gauss points a triangle; allowed: 1, 3 or 6", points));
}

MeshQuadrature mesh_quadrature(const FieldMesh& mesh, int points_per_triangle) {
  MeshQuadrature result;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec2 &a = mesh.nodes[mesh.triangles[t][0]], &b = mesh.nodes[mesh.triangles[t][1]],
               &c = mesh.nodes[mesh.triangles[t][2]];
    const double area = cross(b - a, c - a) / 2;
    for (const QuadraturePoint& point : triangle_rule(points_per_triangle)) {
      result.position.push_back(point.barycentric[0] * a + point.barycentric[1] * b + point.barycentric[2] * c);
      result.weight.push_back(point.share * area);
      result.triangle.push_back(static_cast<int>(t));
    }
  }
  return result;
}

}  // namespace pliant
