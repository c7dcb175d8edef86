#include "reference/linear_solver.hpp"

#include <omp.h>

#include <Eigen/CholmodSupport>
#include <Eigen/UmfPackSupport>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/errors.hpp"

namespace pliant::reference {
namespace {

/// Sparsity pattern of a matrix.
struct Pattern {
  std::vector<int> outer, inner;
  explicit Pattern(const SparseMatrix& matrix)
      : outer(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.outerSize() + 1),
        inner(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros()) {}
  bool operator==(const Pattern&) const = default;
};

/// Factors with an estimate of the reciprocal condition number of a matrix with ones on its diagonal.
struct Cholesky : Eigen::CholmodSupernodalLLT<SparseMatrix> {
  double reciprocal_condition() { return cholmod_rcond(m_cholmodFactor, &cholmod()); }
};
struct Lu : Eigen::UmfPackLU<SparseMatrix> {
  double reciprocal_condition() const { return m_umfpackInfo[UMFPACK_RCOND]; }
};

/// Reciprocal condition number below which rounding determines the solution.
constexpr double singular = 1e-13;

/// Keeps libraries from starting threads during its lifetime. CHOLMOD would start four for every supernode whatever
/// OpenMP's settings: with a thousand degrees of freedom four fifths of the time is waiting for them, on busy machines
/// nearly all.
class OneThread {
 public:
  OneThread() { omp_set_max_active_levels(0); }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_ = omp_get_max_active_levels();
};

/// Factorisation method with the pattern that it has analysed.
template <class Method>
struct Factorisation {
  Method method;
  Pattern pattern{SparseMatrix()};

  /// Returns whether it succeeded.
  bool factorise(const SparseMatrix& matrix, LinearSolver::Counts& counts) {
    if (const Pattern now(matrix); !(now == pattern)) {
      method.analyzePattern(matrix);
      pattern = now;
      ++counts.analyses;
    }
    method.factorize(matrix);
    ++counts.factorisations;
    return method.info() == Eigen::Success && method.reciprocal_condition() > singular;
  }
};

/// Scales that bring the diagonal of a matrix to one: degrees of freedom have different units.
Vector scales_of(const SparseMatrix& matrix) {
  return matrix.diagonal().unaryExpr([](double d) { return d == 0 ? 1.0 : 1 / std::sqrt(std::abs(d)); });
}

}  // namespace

struct LinearSolver::Factors {
  Factorisation<Cholesky> symmetric;
  Factorisation<Lu> general;
};

LinearSolver::LinearSolver() : factors_(std::make_unique<Factors>()) { factors_->symmetric.method.cholmod().print = 0; }
LinearSolver::~LinearSolver() = default;

Vector LinearSolver::solve(const SparseMatrix& matrix, const Vector& right_side, bool symmetric) {
  if (right_side.size() == 0) return {};
  const auto start = std::chrono::steady_clock::now();
  const OneThread alone;
  const Vector scales = scales_of(matrix), right = scales.cwiseProduct(right_side);
  const SparseMatrix scaled = scales.asDiagonal() * matrix * scales.asDiagonal();
  Vector x;
  definite_ = symmetric && factors_->symmetric.factorise(scaled, counts_);
  if (definite_) {
    x = factors_->symmetric.method.solve(right);
  } else if (factors_->general.factorise(scaled, counts_)) {
    x = factors_->general.method.solve(right);
  }
  counts_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (x.size() == right.size() && x.allFinite()) return scales.cwiseProduct(x);
  throw PhysicsError("the tangent is singular: some body is free to move without any force");
}

}  // namespace pliant::reference
