#pragma once

#include "discretisation/table.hpp"

namespace pliant {

/// Half the vector sum of the outward segment vectors at each outline node, [outline nodes]: tributary vectors s_k of
/// tractions (docs/method.md 2), m per metre of thickness. They sum to zero.
Points tributary_vectors(const FieldMesh& mesh);

/// Right-hand side of condition (2), [nodes]: sum over the outline of s_k phi_i(x_k).
Points boundary_moments(const FieldMesh& mesh, const ShapeRows& outline_rows);

/// Changes the table's gradients by the least amount d, in the norm sum_g w_g |d_gi|^2, that makes
/// (1) sum_i b_gi = 0 and sum_i b_gi (x) X_i = I at every point and
/// (2) sum_g w_g b_gi = sum_k s_k phi_i(x_k) for every node
/// (docs/method.md 2; the unsymmetric origin is Chen, Hillman, Rueter 2013). The table's gradients must already be
/// linearly complete, as those of moving least squares are. Coordinates should be of the order of one node distance.
/// Returns the largest residual of (1) and (2). Throws InputError if it stays above 1e-12 (above 4500 nodes: their
/// number times the rounding unit).
double make_gradients_consistent(IntegrationTable& table, const FieldMesh& mesh, const ShapeRows& outline_rows);

/// Largest residual of conditions (1) and (2), relative to gradients 1/h and lengths h of the mean node distance h = 1.
double consistency_residual(const IntegrationTable& table, const FieldMesh& mesh, const ShapeRows& outline_rows);

}  // namespace pliant
