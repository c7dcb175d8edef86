#pragma once

namespace pliant {

/// Memory of a step size controller between steps. It is no part of a state.
struct StepControl {
  double next_dt = 0;  ///< proposed size of the next step, s; 0: none yet
  /// `verlet` reads the largest error over dt^3, of this span of steps and of the last one, 1/s3.
  double jerk = 0, jerk_before = 0;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("next_dt", next_dt), visitor("jerk", jerk), visitor("jerk_before", jerk_before);
  }
};

}  // namespace pliant
