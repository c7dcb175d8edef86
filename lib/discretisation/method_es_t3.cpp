#include <map>

#include "discretisation/methods.hpp"

namespace pliant {
namespace {

/// Triangles at each edge, in the order of the mesh.
std::map<std::pair<int, int>, std::vector<int>> triangles_by_edge(const FieldMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<int>> edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int side = 0; side < 3; ++side) {
      const int a = mesh.triangles[t][side], b = mesh.triangles[t][(side + 1) % 3];
      edges[std::minmax(a, b)].push_back(static_cast<int>(t));
    }
  return edges;
}

}  // namespace

MethodResult build_es_t3(const FieldMesh& mesh) {
  const MethodResult linear = build_at_gauss_points(mesh, linear_triangles(mesh), 1);
  MethodResult result;
  IntegrationTable& table = result.table;
  table.start.push_back(0);
  for (const auto& [edge, triangles] : triangles_by_edge(mesh)) {
    double weight = 0;
    for (int t : triangles) weight += linear.table.weight[t] / 3;
    std::map<int, Vec2> gradient;
    for (int t : triangles)
      for (int e = linear.table.start[t]; e < linear.table.start[t + 1]; ++e)
        gradient.try_emplace(linear.table.node[e], 0, 0).first->second +=
            linear.table.weight[t] / 3 / weight * linear.table.gradient[e];
    table.weight.push_back(weight);
    table.cells.push_back({triangles.front(), triangles.back()});
    for (const auto& [node, b] : gradient) {
      table.node.push_back(node);
      table.gradient.push_back(b);
    }
    table.start.push_back(static_cast<int>(table.node.size()));
  }
  return result;
}

}  // namespace pliant
