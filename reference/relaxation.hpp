#pragma once

#include "reference/newton.hpp"

namespace pliant::reference {

struct RelaxationOptions {
  double tolerance = 1e-10;  ///< as in Newton's method
  double start = 1e-3;       ///< pseudo-inertia of the first step over the largest stiffness
  double longest = 0;        ///< largest displacement of a step, m
  double furthest = 0;       ///< largest displacement of all steps together, m
  int steps = 500;
};

/// Equilibrium by pseudo-transient continuation (Kelley and Keyes, SIAM J. Numer. Anal. 35, 508, 1998): linearly
/// implicit steps of the damped flow mass dx/dtau = -residual, (K + s mass) step = -residual. The share s falls tenfold
/// after a step in which the forces were as linear as expected, and grows if they were not. Steps that would do work
/// against the forces, or for which K + s mass is not positive definite, are repeated with a larger s: the end is a
/// stable equilibrium, whatever kinks the forces have. `mass`: [unknowns], scaled to the largest stiffness; `arms`:
/// [unknowns], displacement per unit, 1 or m; `x`: the start, then the solution.
NewtonResult relax(const Equations& equations, const Vector& mass, const Vector& arms, const RelaxationOptions& options,
                   LinearSolver& solver, Vector& x);

}  // namespace pliant::reference
