#include "discretisation/consistent_gradients.hpp"
#include "discretisation/recipes.hpp"

namespace pliant {

RecipeResult build_mls(const FieldMesh& mesh, const MlsNodes& nodes, const ShapeRows& outline_rows) {
  RecipeResult result = build_mls_gauss(mesh, nodes, 1);
  result.completeness_residual = make_gradients_consistent(result.table, mesh, outline_rows);
  return result;
}

}  // namespace pliant
