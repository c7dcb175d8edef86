#pragma once

#include <vector>

#include "reference/bodies.hpp"

namespace pliant::reference {

/// Matrix that selects the free degrees of freedom: [dofs x free].
inline SparseMatrix selection(const std::vector<int>& free, int dofs) {
  Triplets entries;
  for (std::size_t i = 0; i < free.size(); ++i) entries.emplace_back(free[i], static_cast<int>(i), 1.0);
  SparseMatrix matrix(dofs, static_cast<int>(free.size()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Matrix restricted to the free degrees of freedom, which `select` gives in ascending order.
inline SparseMatrix restricted(const SparseMatrix& matrix, const SparseMatrix& select) {
  std::vector<int> number(static_cast<std::size_t>(matrix.rows()), -1);
  for (int i = 0; i < select.cols(); ++i) number[static_cast<std::size_t>(select.innerIndexPtr()[i])] = i;
  SparseMatrix result(select.cols(), select.cols());
  result.reserve(matrix.nonZeros());
  for (int i = 0; i < select.cols(); ++i) {
    result.startVec(i);
    for (SparseMatrix::InnerIterator entry(matrix, select.innerIndexPtr()[i]); entry; ++entry)
      if (const int row = number[static_cast<std::size_t>(entry.row())]; row >= 0)
        result.insertBack(row, i) = entry.value();
  }
  result.finalize();
  return result;
}

}  // namespace pliant::reference
