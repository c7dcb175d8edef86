#include "discretisation/methods.hpp"
#include "discretisation/quadrature.hpp"

namespace pliant {

MethodResult build_at_gauss_points(const FieldMesh& mesh, const Basis& basis, int gauss_points) {
  const MeshQuadrature quadrature = mesh_quadrature(mesh, gauss_points);
  MethodResult result;
  IntegrationTable& table = result.table;
  table.weight = quadrature.weight;
  table.start.push_back(0);
  for (std::size_t g = 0; g < quadrature.weight.size(); ++g) {
    const int triangle = quadrature.triangle[g];
    const ShapeFunctions shape = basis(quadrature.position[g], triangle);
    table.cells.push_back({triangle, triangle});
    table.node.insert(table.node.end(), shape.node.begin(), shape.node.end());
    table.gradient.insert(table.gradient.end(), shape.gradient.begin(), shape.gradient.end());
    table.start.push_back(static_cast<int>(table.node.size()));
  }
  return result;
}

}  // namespace pliant
