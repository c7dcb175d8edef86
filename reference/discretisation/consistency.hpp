#pragma once

#include <vector>

#include "core/vec2.hpp"
#include "reference/discretisation/space.hpp"

namespace pliant::reference {

/// Symmetric variationally consistent correction (docs/method.md 2): changes all gradients by the d with the least
/// sum_g w_g |d_gi|^2 under
/// (1) at every point sum_i b_gi = 0, sum_i b_gi (x) X_i = I,
/// (2) for every node sum_g w_g b_gi = sum_k s_k phi_i(x_k) over the outline nodes k with the rows `outline`.
/// Lengths in mean node distances. Throws InputError if no solution is found to 1e-11.
void make_consistent(std::vector<Point>& points, const Points& nodes, const std::vector<Row>& outline);

/// Largest residuals of (1) and (2), in the same lengths.
double consistency_error(const std::vector<Point>& points, const Points& nodes, const std::vector<Row>& outline);

}  // namespace pliant::reference
