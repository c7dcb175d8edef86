#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

/// What drag - c m v (bodies/damping_forces.hpp) makes of a step dt, exactly for as long as all other forces stand
/// still: v' = a at its start, of all forces, and a' = -c a. By z = c dt; without drag 0, 1/2, 1. T: double, or Lanes
/// of one body each.
template <class T>
struct Drag {
  T z{};
  T mean{};  ///< mean velocity of the step = v + mean dt a
  T end{};   ///< velocity at its end = v + end dt a
};

/// z >= 0.
Drag<double> drag_over(double z);
Drag<Lanes> drag_over(Lanes z);

/// c of a rigid degree of freedom, 1/s.
double drag_rate(const RigidDof& dof, const Instant& at);

/// What drag takes. Velocities are as a state holds them.
class DragLoss {
 public:
  explicit DragLoss(const Model& model) : model_(model) {}
  /// At given velocities, W/m.
  double power(const Instant& at, const Dofs& velocity);
  /// In a step dt from `at` on, from the velocity at its start and the mean one, J/m.
  double work(const Instant& at, double dt, const Dofs& velocity, const Dofs& mean);

 private:
  /// sum of weight(c) m y . v over all degrees of freedom, v the material velocity of y.
  template <class Weight>
  double weighted_square(const Instant& at, const Dofs& y, Weight&& weight);

  const Model& model_;
  Dofs deviation_, moving_;  ///< scratch
};

}  // namespace pliant
