#include "dynamics/mass_damping.hpp"

#include <cmath>

#include "bodies/damping_forces.hpp"
#include "bodies/node_arrays.hpp"
#include "bodies/reciprocal_mass.hpp"

namespace pliant {
namespace {

/// sum over k of (-z)^k / (k + n)!: remainder of exp(-z) after n terms, over (-z)^n. rest(n) = 1/n! - z rest(n + 1).
double rest_of_exponential(double z, int n) {
  double factorial = 1;
  if (z > 1) {  // the recursion upwards from n = 1 has no cancellation then
    double rest = -std::expm1(-z) / z;
    for (int k = 1; k < n; ++k) factorial *= k, rest = (1 / factorial - rest) / z;
    return rest;
  }
  for (int k = 2; k <= n; ++k) factorial *= k;
  double term = 1 / factorial, sum = 0;
  constexpr int terms = 18;  // 1/18! is rounding
  for (int k = 1; k <= terms; ++k) sum += term, term *= -z / (n + k);
  return sum;
}

/// Mean square of the velocity's deviation from its mean over that of the velocity at the start: 1/3 without mass
/// damping, when it is linear in time.
double relative_variance(double z) {
  const double mean = rest_of_exponential(z, 2);
  return (4 * rest_of_exponential(2 * z, 3) - 2 * rest_of_exponential(z, 3)) / (mean * mean) - 1;
}

}  // namespace

DampedStep<double> damped_step(double z) { return {z, rest_of_exponential(z, 2), rest_of_exponential(z, 1)}; }

DampedStep<Lanes> damped_step(Lanes z) {
  DampedStep<Lanes> result{z};
  for (int lane = 0; lane < lane_count; ++lane) {
    const DampedStep<double> one = damped_step(z[lane]);
    result.mean[lane] = one.mean;
    result.end[lane] = one.end;
  }
  return result;
}

double damping_rate(const RigidDof& dof, const Instant& at) {
  return dof.mass > 0 ? damping_coefficient(dof, at) / dof.mass : 0.0;
}

template <class Weight>
double DampingLoss::weighted_square(const Instant& at, const Dofs& y, Weight&& weight) {
  const Dofs& v = material_velocity(model_, y, moving_);
  double total = ordered_sum(static_cast<int>(model_.regions.size()), [&](int r) {
    const Region& region = model_.regions[r];
    const Batch& batch = model_.batches[region.batch];
    if (!batch.mass_damped) return 0.0;
    Lanes factor{}, square{};
    for (int lane = 0; lane < lane_count; ++lane) factor[lane] = weight(batch.mass_damping[lane]);
    const Lanes *here = &y.compliant[batch.offset], *moving = &v.compliant[batch.offset];
    with_nodes(model_, batch, [&](const auto& nodes) {
      for (int i = 2 * region.first; i < 2 * region.last; ++i)
        square += nodes.mass_at_unit_density[i / 2] * (here[i] * moving[i]);
    });
    return sum(factor * square * batch.density * batch.weight);
  });
  for (std::size_t r = 0; r < model_.rigid_bodies.size(); ++r)
    for (std::size_t c = 0; c < 3; ++c) {
      const RigidDof& dof = model_.rigid_bodies[r].dof[c];
      total += weight(damping_rate(dof, at)) * dof.mass * y.rigid[3 * r + c] * y.rigid[3 * r + c];
    }
  return total;
}

double DampingLoss::power(const Instant& at, const Dofs& velocity) {
  return weighted_square(at, velocity, [](double c) { return c; });
}

double DampingLoss::work(const Instant& at, double dt, const Dofs& velocity, const Dofs& mean) {
  deviation_ = velocity;
  for (std::size_t i = 0; i < deviation_.compliant.size(); ++i) deviation_.compliant[i] -= mean.compliant[i];
  for (std::size_t i = 0; i < deviation_.rigid.size(); ++i) deviation_.rigid[i] -= mean.rigid[i];
  return dt * (weighted_square(at, mean, [](double c) { return c; }) +
               weighted_square(at, deviation_, [&](double c) { return c * relative_variance(c * dt); }));
}

}  // namespace pliant
