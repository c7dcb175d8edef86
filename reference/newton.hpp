#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reference/linear_solver.hpp"

namespace pliant::reference {

/// A system of equations at one place.
struct Linearisation {
  Vector residual;
  Vector magnitude;     ///< sum of the absolute values of what cancels in it
  SparseMatrix matrix;  ///< its derivative; empty unless asked for
  bool symmetric = true;
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
  int iterations = 0;
  std::vector<double> residuals;  ///< [iterations + 1], relative
  std::string trouble;            ///< why it did not
};

/// Newton's method with a line search that keeps to admissible places. Residuals are measured in the norm of the inverse diagonal of the first
/// matrix, an energy, so that forces and moments can be added. `x`: the start, then the solution, at which `equations` was asked last.
NewtonResult solve_newton(const Equations& equations, const NewtonOptions& options, LinearSolver& solver, Vector& x);

}  // namespace pliant::reference
