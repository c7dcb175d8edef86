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

/// What drag takes at given velocities, W/m. Velocities are as a state holds them.
double drag_power(const Model& model, const Instant& at, const Dofs& velocity);

/// What drag takes in a step dt from `at` on, from the velocity at its start and the mean one, J/m.
double drag_work(const Model& model, const Instant& at, double dt, const Dofs& velocity, const Dofs& mean);

}  // namespace pliant
