#include <algorithm>

#include "discretisation/quadrature.hpp"
#include "discretisation/recipes.hpp"

namespace pliant {

RecipeResult build_mls_gauss(const FieldMesh& mesh, const MlsNodes& nodes, int gauss_points) {
  const MeshQuadrature quadrature = mesh_quadrature(mesh, gauss_points);
  RecipeResult result;
  IntegrationTable& table = result.table;
  table.weight = quadrature.weight;
  table.triangle = quadrature.triangle;
  table.start.push_back(0);
  for (const Vec2& x : quadrature.position) {
    const ShapeFunctions shape = evaluate_mls(nodes, x);
    table.node.insert(table.node.end(), shape.node.begin(), shape.node.end());
    table.gradient.insert(table.gradient.end(), shape.gradient.begin(), shape.gradient.end());
    table.start.push_back(static_cast<int>(table.node.size()));
    result.min_shape_value =
        std::min(result.min_shape_value, *std::min_element(shape.value.begin(), shape.value.end()));
  }
  return result;
}

}  // namespace pliant
