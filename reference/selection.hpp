#pragma once

#include <vector>

#include "reference/bodies.hpp"

namespace pliant::reference {

/// Picks the free degrees of freedom: [dofs x free].
inline SparseMatrix selection(const std::vector<int>& free, int dofs) {
  Triplets entries;
  for (std::size_t i = 0; i < free.size(); ++i) entries.emplace_back(free[i], static_cast<int>(i), 1.0);
  SparseMatrix matrix(dofs, static_cast<int>(free.size()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Of the free degrees of freedom alone.
inline SparseMatrix restricted(const SparseMatrix& matrix, const SparseMatrix& select) {
  return SparseMatrix(select.transpose()) * matrix * select;
}

}  // namespace pliant::reference
