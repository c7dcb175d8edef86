#include "reference/newton.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/errors.hpp"

namespace pliant::reference {
namespace {

constexpr int halvings = 12;  ///< maximum for one step
/// The residual may exceed the last one, but not the largest of this many: contact forces have kinks.
constexpr int memory = 4;
constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

/// Share of the step that reduces the residual; if none does, the one with the least residual.
double search(const Equations& equations, const Measure& measure, const Vector& x, const Vector& step, double allowed,
              Linearisation& found) {
  double best = 0, least = std::numeric_limits<double>::infinity(), share = 1;
  std::string trouble;
  for (int i = 0; i <= halvings; ++i, share *= 0.5) {
    Linearisation trial = equations(x + share * step, false);
    if (!trial.admissible) {
      trouble = trial.trouble;
      continue;
    }
    const double size = measure(trial.residual);
    if (size < least) best = share, least = size;
    if (size <= (1 - 1e-4 * share) * allowed) break;
  }
  found.trouble = trouble;
  return best;
}

}  // namespace

Measure::Measure(const Linearisation& start)
    : stiffness_(start.matrix.diagonal().cwiseAbs()), sensitivity_(start.sensitivity) {
  if (sensitivity_.size() == 0) sensitivity_ = Vector::Zero(stiffness_.size());
  weight_ = stiffness_.cwiseMax(1e-14 * stiffness_.maxCoeff()).cwiseSqrt().cwiseInverse();
}

double Measure::relative(const Linearisation& at) const {
  const double whole = (*this)(at.magnitude);
  return whole > 0 ? (*this)(at.residual) / whole : 0.0;
}

bool Measure::vanishes(const Linearisation& at, const Vector& x, double tolerance) const {
  const double floor = rounding * (*this)(x.lpNorm<Eigen::Infinity>() * stiffness_ + sensitivity_);
  return (*this)(at.residual) <= tolerance * (*this)(at.magnitude) + floor;
}

NewtonResult solve_newton(const Equations& equations, const NewtonOptions& options, LinearSolver& solver, Vector& x) {
  NewtonResult result;
  Linearisation at = equations(x, true);
  if (!at.admissible) {
    result.trouble = at.trouble;
    return result;
  }
  if (x.size() == 0) {  // everything is imposed
    result.converged = true;
    return result;
  }
  const Measure measure(at);
  std::vector<double> sizes;
  for (;; ++result.iterations) {
    result.residuals.push_back(measure.relative(at));
    sizes.push_back(measure(at.residual));
    result.converged = measure.vanishes(at, x, options.tolerance);
    if (result.converged) return result;
    if (result.iterations == options.iterations) break;
    Vector step;
    try {
      step = solver.solve(at.matrix, -at.residual, at.symmetric);
      result.stable = !at.symmetric || solver.definite();
    } catch (const PhysicsError& singular) {
      result.trouble = singular.what();
      return result;
    }
    const auto recent = sizes.end() - std::min<std::ptrdiff_t>(memory, static_cast<std::ptrdiff_t>(sizes.size()));
    const double share = search(equations, measure, x, step, *std::max_element(recent, sizes.end()), at);
    if (share == 0) {
      result.trouble = at.trouble;
      return result;
    }
    x += share * step;
    at = equations(x, true);
  }
  result.trouble = fmt::format("no convergence in {} iterations, relative residual {:.3g}, allowed {:.3g}",
                               options.iterations, result.residuals.back(), options.tolerance);
  return result;
}

}  // namespace pliant::reference
