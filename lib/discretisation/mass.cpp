#include "discretisation/mass.hpp"

#include <fmt/format.h>

#include "core/errors.hpp"
#include "discretisation/quadrature.hpp"

namespace pliant {

std::vector<double> lumped_mass(const FieldMesh& mesh, const Basis& basis) {
  const MeshQuadrature quadrature = mesh_quadrature(mesh, 6);
  std::vector<double> mass(mesh.nodes.size(), 0);
  for (std::size_t g = 0; g < quadrature.weight.size(); ++g) {
    const ShapeFunctions shape = basis(quadrature.position[g], quadrature.triangle[g]);
    for (std::size_t a = 0; a < shape.node.size(); ++a) mass[shape.node[a]] += quadrature.weight[g] * shape.value[a];
  }
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (!(mass[i] > 0))
      throw InputError(
          fmt::format("discretisation: lumped mass {:.3g} (in squared node distances) of node {}; it must be "
                      "positive: change `support` or the number of nodes",
                      mass[i], i));
  return mass;
}

}  // namespace pliant
