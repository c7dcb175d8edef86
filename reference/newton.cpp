#include "reference/newton.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/errors.hpp"

namespace pliant::reference {
namespace {

constexpr int halvings = 12;  ///< of the step, at most
constexpr int memory =
    4;  ///< the residual may grow against the last one, but not against the largest of so many: forces of contact have kinks
constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

/// Residuals in the norm of an inverse diagonal.
class Measure {
 public:
  explicit Measure(const Linearisation& start) : weight_(start.matrix.diagonal().cwiseAbs()) {
    const double largest = weight_.maxCoeff();
    stiffness_ = weight_;
    weight_ = weight_.cwiseMax(1e-14 * largest).cwiseSqrt().cwiseInverse();
  }
  double operator()(const Vector& residual) const { return residual.cwiseProduct(weight_).norm(); }
  /// What rounding of the positions makes of the residual.
  double floor(const Vector& x) const { return rounding * (*this)(x.lpNorm<Eigen::Infinity>() * stiffness_); }

 private:
  Vector weight_, stiffness_;
};

/// The step's share that lowers the residual; of those that do not, the one with the least.
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
    const double size = measure(at.residual), whole = measure(at.magnitude);
    result.residuals.push_back(whole > 0 ? size / whole : 0.0);
    sizes.push_back(size);
    result.converged = size <= options.tolerance * whole + measure.floor(x);
    if (result.converged) return result;
    if (result.iterations == options.iterations) break;
    Vector step;
    try {
      step = solver.solve(at.matrix, -at.residual, at.symmetric);
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
