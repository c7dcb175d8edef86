#pragma once

#include "dynamics/forces.hpp"
#include "dynamics/state.hpp"

namespace pliant {

/// Positions and forces under trial: they become the state's own when the step is accepted.
struct Trial {
  Dofs position, velocity, force;
  ContactHistory history;
};

/// Makes an accepted trial the state at `end_time`: books its work and dissipation, swaps, counts the step.
void take_over(const Model& model, State& state, Trial& trial, double end_time, double dt, double dissipated);

/// One accepted step.
struct StepReport {
  double dt = 0, error = 0;
  int rejections = 0;
  Evaluation evaluation;         ///< the last one
  const char* governed_by = "";  ///< what limited dt: "error", "stability", "output", "start"
};

/// Throws PhysicsError when dt has fallen under 1e-9 of `reference`: with what the last trial, rejected, found at `time`.
void check_time_step(double dt, double reference, const StepReport& rejected, double time, Forces& forces);

}  // namespace pliant
