#include "discretisation/consistent_gradients.hpp"
#include "discretisation/methods.hpp"

namespace pliant {

MethodResult build_mls(const FieldMesh& mesh, const Basis& basis, const ShapeRows& outline_rows) {
  MethodResult result = build_at_gauss_points(mesh, basis, 1);
  result.completeness_residual = make_gradients_consistent(result.table, mesh, outline_rows);
  return result;
}

}  // namespace pliant
