#include "discretisation/consistent_gradients.hpp"
#include "discretisation/recipes.hpp"

namespace pliant {

RecipeResult build_mls(const FieldMesh& mesh, const Basis& basis, const ShapeRows& outline_rows) {
  RecipeResult result = build_at_gauss_points(mesh, basis, 1);
  result.completeness_residual = make_gradients_consistent(result.table, mesh, outline_rows);
  return result;
}

}  // namespace pliant
