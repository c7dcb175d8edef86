#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

/// Effect of mass damping - c m v (bodies/damping_forces.hpp) on a step dt, exact while all other forces are constant:
/// v' = a at the start, with a by all forces, and a' = -c a. As functions of z = c dt; without mass damping 0, 1/2, 1.
/// T: double, or Lanes with one body each.
template <class T>
struct DampedStep {
  T z{};
  T mean{};  ///< mean velocity of the step = v + mean dt a
  T end{};   ///< velocity at its end = v + end dt a
};

/// Coefficients for z >= 0.
DampedStep<double> damped_step(double z);
DampedStep<Lanes> damped_step(Lanes z);

/// Damping rate c of a rigid degree of freedom, 1/s.
double damping_rate(const RigidDof& dof, const Instant& at);

/// Energy dissipated by mass damping. Velocities are as a state holds them.
class DampingLoss {
 public:
  explicit DampingLoss(const Model& model) : model_(model) {}
  /// Power at given velocities, W/m.
  double power(const Instant& at, const Dofs& velocity);
  /// Work in a step dt from `at` on, from the velocity at its start and the mean velocity, J/m.
  double work(const Instant& at, double dt, const Dofs& velocity, const Dofs& mean);

 private:
  /// Sum of weight(c) m y . v over all degrees of freedom, with v the material velocity of y.
  template <class Weight>
  double weighted_square(const Instant& at, const Dofs& y, Weight&& weight);

  const Model& model_;
  Dofs deviation_, moving_;  ///< scratch
};

}  // namespace pliant
