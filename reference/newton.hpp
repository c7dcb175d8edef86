#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reference/linear_solver.hpp"

namespace pliant::reference {

/// System of equations, linearised at one point.
struct Linearisation {
  Vector residual;
  Vector magnitude;  ///< sum of the absolute values of its terms
  /// Sensitivity of the residual to a relative rounding of the offsets to which the unknowns are added; empty: no
  /// offsets.
  Vector sensitivity;
  SparseMatrix matrix;  ///< its derivative; empty unless requested
  bool symmetric = true;
  double potential = 0;    ///< potential whose gradient is the residual, if the matrix is symmetric, J/m
  bool admissible = true;  ///< false: J <= 0, or a lost contact
  std::string trouble;     ///< reason why it is not admissible
};

using Equations = std::function<Linearisation(const Vector& x, bool tangent)>;

struct NewtonOptions {
  double tolerance = 1e-10;  ///< residual over the magnitude of its terms
  int iterations = 40;
};

struct NewtonResult {
  bool converged = false;
  bool stable = true;  ///< the last matrix, if symmetric, was positive definite
  int iterations = 0;
  std::vector<double> residuals;  ///< [iterations + 1], relative
  std::string trouble;            ///< reason why it did not converge
};

/// Norm of residuals by an inverse diagonal, an energy, so that forces and moments can be added.
class Measure {
 public:
  explicit Measure(const Linearisation& start);
  double operator()(const Vector& residual) const { return residual.cwiseProduct(weight_).norm(); }
  /// Residual over the magnitude of its terms.
  double relative(const Linearisation& at) const;
  /// Whether the residual is within the tolerance, or within the rounding of the positions.
  bool vanishes(const Linearisation& at, const Vector& x, double tolerance) const;

 private:
  Vector weight_, stiffness_, sensitivity_;
};

/// Newton's method with a line search that stays at admissible points. Residuals are measured with the first matrix.
/// `x`: the start, then the solution, at which `equations` was evaluated last.
NewtonResult solve_newton(const Equations& equations, const NewtonOptions& options, LinearSolver& solver, Vector& x);

}  // namespace pliant::reference
