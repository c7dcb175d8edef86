#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reference/linear_solver.hpp"

namespace pliant::reference {

/// A system of equations at one place.
struct Linearisation {
  Vector residual;
  Vector magnitude;  ///< sum of the absolute values of what cancels in it
  /// Of the residual to a relative rounding of all that the unknowns are added to; empty: they are added to nothing.
  Vector sensitivity;
  SparseMatrix matrix;  ///< its derivative; empty unless asked for
  bool symmetric = true;
  double potential = 0;    ///< what the residual is the gradient of, where the matrix is symmetric, J/m
  bool admissible = true;  ///< else the place cannot be: J <= 0, or a contact that is lost
  std::string trouble;     ///< why not
};

using Equations = std::function<Linearisation(const Vector& x, bool tangent)>;

struct NewtonOptions {
  double tolerance = 1e-10;  ///< residual over the magnitude of what cancels in it
  int iterations = 40;
};

struct NewtonResult {
  bool converged = false;
  bool stable = true;  ///< the last matrix, where symmetric, was positive definite
  int iterations = 0;
  std::vector<double> residuals;  ///< [iterations + 1], relative
  std::string trouble;            ///< why it did not
};

/// Residuals in the norm of an inverse diagonal, an energy, so that forces and moments can be added.
class Measure {
 public:
  explicit Measure(const Linearisation& start);
  double operator()(const Vector& residual) const { return residual.cwiseProduct(weight_).norm(); }
  /// Over the magnitude of what cancels in it.
  double relative(const Linearisation& at) const;
  /// Whether the residual is within the tolerance, or what rounding of the positions makes of it.
  bool vanishes(const Linearisation& at, const Vector& x, double tolerance) const;

 private:
  Vector weight_, stiffness_, sensitivity_;
};

/// Newton's method with a line search that keeps to admissible places. Residuals are measured with the first matrix.
/// `x`: the start, then the solution, at which `equations` was asked last.
NewtonResult solve_newton(const Equations& equations, const NewtonOptions& options, LinearSolver& solver, Vector& x);

}  // namespace pliant::reference
