#pragma once

#include "dynamics/step_control.hpp"
#include "dynamics/trial.hpp"

namespace pliant {

/// Step that an integrator tries next.
struct Proposal {
  double dt = 0, end_time = 0;  ///< s
  double controller_dt = 0;     ///< dt but for the time at which the step must end, s
  double largest_dt = 0;        ///< what limits dt when no error does, s
  StepLimit limited_by = StepLimit::until;
  bool is_output_sample = false;  ///< a shorter step for an observer: it takes the candidates as they are
};

/// The controller's answer to a trial.
struct Verdict {
  bool accepted;
  StepControl control;  ///< for the next trial, or for the next step
};

/// Evaluates forces at a state's own positions and velocities into a trial; finds contact candidates if there are none.
/// The trial's history variables are those of the state after an evaluation without a time increment.
Evaluation evaluate_at(Forces& forces, State& state, Trial& trial);

/// The same, and the state takes over the forces, mass damping included, and the history variables of its motion.
Evaluation find_forces(Forces& forces, State& state);

/// Swaps the motion of a state and a trial.
void swap_motion(State& state, Trial& trial);

/// Makes an accepted trial the state: adds its work and dissipation, swaps and counts. Where loads switch, the state's
/// forces become those of the next step. Only acceptance changes a state, so that a step that throws leaves it as it
/// was; new contact candidates may have put the records of its memory in another order.
void take_over(const Model& model, State& state, Trial& trial, const StepReport& report);

}  // namespace pliant
