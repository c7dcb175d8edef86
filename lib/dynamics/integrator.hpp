#pragma once

#include "dynamics/forces.hpp"
#include "dynamics/state.hpp"

namespace pliant {

/// Positions and forces under trial: they become the state's own when the step is accepted.
struct Trial {
  Dofs position, velocity, force;
  ContactHistory history;
};

/// One accepted step, or the trials so far.
struct StepReport {
  double dt = 0, error = 0;
  double damping_work = 0;  ///< dissipated by forces that depend on velocities, J/m
  int rejections = 0, evaluations = 0;
  Evaluation evaluation;         ///< the last one
  const char* governed_by = "";  ///< what limited dt: "error", "stability", "output", "start"
};

/// Makes an accepted trial the state at `end_time`: books its work and dissipation, swaps, counts. Where loads switch, the state's forces become those
/// of the next step. Only acceptance changes a state, so that a step
/// that throws leaves it as it was; a refresh of the contact candidates may have put the history's records in another order.
void take_over(const Model& model, State& state, Trial& trial, double end_time, double next_dt,
               const StepReport& report);

}  // namespace pliant
