#include "reference/relaxation.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/errors.hpp"

namespace pliant::reference {
namespace {

constexpr double least = 1e-12, most = 1e4;           ///< bounds of the share
constexpr double faster = 0.1, slower = 2, back = 4;  ///< factors on the share
constexpr double linear = 0.1, barely_linear = 0.5;   ///< error of the linear model over the residual at the start
constexpr double creep = 0.1;                         ///< steps shorter than this share of the longest may cross kinks
constexpr double flat = 1e-6;  ///< share of a potential within which rounding of small strains may decide its change

SparseMatrix held(const SparseMatrix& matrix, const Vector& holding) {
  return matrix + SparseMatrix(holding.asDiagonal());
}

double largest(const Vector& step, const Vector& arms) { return step.cwiseProduct(arms).lpNorm<Eigen::Infinity>(); }

/// Error of the linear model of the forces after a step, over the forces before it.
double model_error(const Measure& measure, const Linearisation& at, const Linearisation& next, const Vector& step) {
  return measure(next.residual - at.residual - at.matrix * step) / measure(at.residual);
}

/// Whether a step increases the energy. If the change is too small, or forces have no potential, the trapezoidal rule
/// decides (as Hager and Zhang, SIAM J. Optim. 16, 170, 2005, end their line searches).
bool climbs(const Measure& measure, const Linearisation& at, const Linearisation& next, const Vector& step) {
  if (at.symmetric && next.symmetric) {
    const double taken = next.potential - at.potential;
    if (taken <= 0 || taken > flat * std::abs(at.potential)) return taken > 0;
  }
  return (at.residual + next.residual).dot(step) > 0 && measure(next.residual) > measure(at.residual);
}

/// One step, no longer than allowed; empty unless it goes downhill.
Vector downhill(const Linearisation& at, const Vector& holding, const Vector& arms, double longest,
                LinearSolver& solver) {
  Vector step;
  try {
    step = solver.solve(held(at.matrix, holding), -at.residual, at.symmetric);
  } catch (const PhysicsError&) {
    return {};
  }
  if ((at.symmetric && !solver.definite()) || step.dot(at.residual) > 0) return {};
  const double moved = largest(step, arms);
  return moved > longest ? Vector(longest / moved * step) : step;
}

}  // namespace

NewtonResult relax(const Equations& equations, const Vector& mass, const Vector& arms, const RelaxationOptions& options,
                   LinearSolver& solver, Vector& x) {
  NewtonResult result;
  Linearisation at = equations(x, true);
  if (!at.admissible) {
    result.trouble = at.trouble;
    return result;
  }
  const Measure measure(at);
  const Vector start = x;
  double share = options.start;
  for (; share < most && largest(x - start, arms) <= options.furthest; ++result.iterations) {
    result.residuals.push_back(measure.relative(at));
    result.converged = measure.vanishes(at, x, options.tolerance);
    if (result.converged || result.iterations == options.steps) break;
    const Vector step = downhill(at, share * mass, arms, options.longest, solver);
    if (step.size() == 0) {
      share *= back;
      continue;
    }
    const Linearisation next = equations(x + step, true);
    const double error = next.admissible ? model_error(measure, at, next, step) : 0;
    const bool leaps = error > barely_linear && largest(step, arms) > creep * options.longest;
    if (!next.admissible || leaps || climbs(measure, at, next, step)) {
      share *= back;
      continue;
    }
    share = std::max(least, share * (error < linear ? faster : error < barely_linear ? 1 : slower));
    x += step;
    at = next;
  }
  if (!result.converged)
    result.trouble = fmt::format(
        "no equilibrium after {} steps of pseudo-transient continuation, over {:.3g} m; relative residual {:.3g}, "
        "allowed {:.3g}",
        result.iterations, largest(x - start, arms), result.residuals.back(), options.tolerance);
  return result;
}

}  // namespace pliant::reference
