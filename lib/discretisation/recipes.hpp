#pragma once

#include "discretisation/mls.hpp"

namespace pliant {

/// What a recipe gives; coordinates in mean node distances.
struct RecipeResult {
  IntegrationTable table;
  double min_shape_value = 0;
  double completeness_residual = 0;
};

/// Moving least squares at Gauss points of the background triangles, the paper's recipe. Fails the patch test.
RecipeResult build_mls_gauss(const FieldMesh& mesh, const MlsNodes& nodes, int gauss_points);

/// One point a triangle, moving least squares with symmetric variationally consistent gradients; passes the patch test.
RecipeResult build_mls(const FieldMesh& mesh, const MlsNodes& nodes, const ShapeRows& outline_rows);

}  // namespace pliant
