#pragma once

#include <memory>

#include "reference/bodies.hpp"

namespace pliant::reference {

/// Solves sparse systems by SuiteSparse: CHOLMOD for symmetric positive definite matrices, UMFPACK for others. The
/// symbolic factorisation is kept as long as the pattern does not change.
class LinearSolver {
 public:
  LinearSolver();
  ~LinearSolver();

  /// Throws PhysicsError for a singular matrix.
  Vector solve(const SparseMatrix& matrix, const Vector& right_side, bool symmetric);

  /// Whether the last matrix was symmetric and positive definite.
  bool definite() const { return definite_; }

  struct Counts {
    long analyses = 0, factorisations = 0;
    double seconds = 0;  ///< in analyses, factorisations and solutions
  };
  const Counts& counts() const { return counts_; }

 private:
  struct Factors;
  bool definite_ = false;
  std::unique_ptr<Factors> factors_;
  Counts counts_;
};

}  // namespace pliant::reference
