#pragma once

#include "discretisation/basis.hpp"

namespace pliant {

/// Result of a discretisation; coordinates in mean node distances.
struct MethodResult {
  IntegrationTable table;
  double completeness_residual = 0;
};

/// Full derivatives of a basis at Gauss points of the background triangles. With moving least squares this is the
/// paper's discretisation, which fails the patch test; with linear triangles and one point it is the finite element
/// method.
MethodResult build_at_gauss_points(const FieldMesh& mesh, const Basis& basis, int gauss_points);

/// Moving least squares with one point per triangle and symmetric variationally consistent gradients; passes the patch
/// test.
MethodResult build_mls(const FieldMesh& mesh, const Basis& basis, const ShapeRows& outline_rows);

/// Linear triangles smoothed over edges (ES-FEM; Liu, Nguyen-Thoi, Lam 2009, doi 10.1016/j.jsv.2008.08.027): one point
/// per edge, with the mean gradient over the thirds of the triangles at it; passes the patch test.
MethodResult build_es_t3(const FieldMesh& mesh);

}  // namespace pliant
