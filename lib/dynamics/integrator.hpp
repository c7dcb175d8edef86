#pragma once

#include <functional>

#include "dynamics/failure.hpp"
#include "dynamics/trial.hpp"

namespace pliant {

/// What an integrator tries next.
struct Proposal {
  double dt = 0, end_time = 0;   ///< s
  double wish = 0;               ///< dt but for the time at which the step must end, s
  double largest_dt = 0;         ///< what limits dt when no error does, s
  const char* governed_by = "";  ///< what limits dt: "error", "stability", "until"
  bool is_look = false;          ///< a shorter step for an observer: it takes the candidates as they are
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

/// Of a state and a trial what moves changes places.
void swap_motion(State& state, Trial& trial);

/// Makes an accepted trial the state: books its work and dissipation, swaps, counts. Where loads switch, the state's
/// forces become those of the next step. Only acceptance changes a state, so that a step that throws leaves it as it
/// was; new contact candidates may have put the records of its memory in another order.
void take_over(const Model& model, State& state, Trial& trial, double next_dt, const StepReport& report);

/// Looks at a motion at times of its own, and leaves it as it is.
struct Observer {
  std::function<double()> next_time;  ///< of the next look, s
  /// At the state, which stands at that time. False if the step is not to be taken: enough has been seen.
  std::function<bool()> look;
  /// Where a state stands, which is for who takes the steps.
  bool looks_at(double time) const { return next_time() == time; }
  /// On the way to another time: up to there but for rounding, which would be left over for the next step.
  bool looks_before(double time) const { return next_time() <= time * (1 + 1e-12) && !looks_at(time); }
};

/// The state as it is after a shorter step, which does not count, while this lives: then it is where it was.
class ShorterStep {
 public:
  ShorterStep(const Model& model, State& state, Trial& trial, const StepReport& report)
      : state_(state), trial_(trial), numbers_(state) {
    take_over(model, state, trial, state.next_dt, report);
    state.steps = numbers_.steps, state.rejections = numbers_.rejections, state.evaluations = numbers_.evaluations;
  }
  ~ShorterStep() {
    swap_motion(state_, trial_);
    static_cast<StateNumbers&>(state_) = numbers_;
  }
  ShorterStep(const ShorterStep&) = delete;
  ShorterStep& operator=(const ShorterStep&) = delete;

 private:
  State& state_;
  Trial& trial_;
  const StateNumbers numbers_;
};

enum class Shown { all, enough, failed };

/// Shows an observer, if any, what an attempt passed by, at the ends of shorter steps from where it began, and makes it
/// again. `failed` if a shorter one does not stand.
template <class Scheme>
Shown show_on_the_way(Scheme& scheme, Forces& forces, State& state, const Proposal& proposal,
                      const Observer* observer) {
  if (!observer || !observer->looks_before(proposal.end_time)) return Shown::all;
  do {
    Proposal shorter = proposal;
    shorter.end_time = observer->next_time(), shorter.dt = shorter.end_time - state.time, shorter.is_look = true;
    StepReport report;
    report.dt = shorter.dt;
    scheme.attempt(state, shorter, report);
    if (!scheme.stands(report)) return Shown::failed;
    scheme.finish(state, report);
    const ShorterStep step(forces.model(), state, scheme.trial(), report);
    if (!observer->look()) return Shown::enough;
  } while (observer->looks_before(proposal.end_time));
  StepReport again;
  scheme.attempt(state, proposal, again);
  return Shown::all;
}

/// One accepted step that ends at `until` at the latest, of whatever scheme: it proposes, attempts, judges and
/// finishes. An observer, if any, sees what the step passes by, and the step is the same, or is not taken: then its
/// report has no length.
template <class Scheme>
StepReport take_step(Scheme& scheme, Forces& forces, State& state, double until, const Observer* observer = nullptr) {
  double next_dt = state.next_dt > 0 ? state.next_dt : scheme.first_dt();
  StepReport report;
  for (;;) {
    const Proposal proposal = scheme.propose(state, next_dt, until);
    report.dt = proposal.dt;
    report.governed_by = proposal.governed_by;
    scheme.attempt(state, proposal, report);
    if (scheme.stands(report)) {
      const Shown shown = show_on_the_way(scheme, forces, state, proposal, observer);
      if (shown == Shown::enough) return {};
      if (shown == Shown::failed) {
        until = observer->next_time();  // by a step of its own, which may be rejected
        continue;
      }
    }
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
