#pragma once

#include <functional>

#include "dynamics/integrator.hpp"

namespace pliant {

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
    take_over(model, state, trial, {true, state.next_dt, state.errors}, report);
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
    shorter.end_time = observer->next_time(), shorter.dt = shorter.end_time - state.time,
    shorter.is_output_sample = true;
    StepReport report;
    report.dt = shorter.dt;
    scheme.attempt(state, shorter, report);
    if (!scheme.within_tolerance(report)) return Shown::failed;
    scheme.finish(state, report);
    const ShorterStep step(forces.model(), state, scheme.trial(), report);
    if (!observer->look()) return Shown::enough;
  } while (observer->looks_before(proposal.end_time));
  StepReport again;
  scheme.attempt(state, proposal, again);
  return Shown::all;
}

}  // namespace pliant
