#pragma once

#include "dynamics/failure.hpp"
#include "dynamics/trial.hpp"

namespace pliant {

/// What an integrator tries next.
struct Proposal {
  double dt = 0, end_time = 0;   ///< s
  double wish = 0;               ///< dt but for the time at which the step must end, s
  double largest_dt = 0;         ///< what limits dt when no error does, s
  const char* governed_by = "";  ///< what limits dt: "error", "stability", "output"
};

/// What is made of a trial.
struct Verdict {
  bool accepted;
  double next_dt;  ///< of the next trial, or of the next step, s
};

/// Forces at a state's own positions and velocities, into a trial; finds contact candidates if there are none. The
/// trial's memory is that of the state after an evaluation in which time stands still.
Evaluation evaluate_at(Forces& forces, State& state, Trial& trial);

/// The same, and the state takes over the forces, drag among them, and the memory that go with its motion.
Evaluation find_forces(Forces& forces, State& state);

/// Makes an accepted trial the state: books its work and dissipation, swaps, counts. Where loads switch, the state's
/// forces become those of the next step. Only acceptance changes a state, so that a step that throws leaves it as it
/// was; new contact candidates may have put the records of its memory in another order.
void take_over(const Model& model, State& state, Trial& trial, double next_dt, const StepReport& report);

/// One accepted step that ends at `until` at the latest, of whatever scheme: it proposes, attempts, judges and
/// finishes.
template <class Scheme>
StepReport take_step(Scheme& scheme, Forces& forces, State& state, double until) {
  double next_dt = state.next_dt > 0 ? state.next_dt : scheme.first_dt();
  StepReport report;
  for (;;) {
    const Proposal proposal = scheme.propose(state, next_dt, until);
    report.dt = proposal.dt;
    report.governed_by = proposal.governed_by;
    scheme.attempt(state, proposal, report);
    const Verdict verdict = scheme.judge(state, proposal, report);
    next_dt = verdict.next_dt;
    if (verdict.accepted) break;
    ++report.rejections;
    check_time_step({report, scheme.trial(), next_dt, proposal.largest_dt, scheme.governing()}, state, forces);
  }
  forces.warn_of_depth(report.evaluation, scheme.trial().time);
  scheme.finish(state, report);
  take_over(forces.model(), state, scheme.trial(), next_dt, report);
  scheme.accepted(state, report);
  return report;
}

}  // namespace pliant
