#pragma once

#include <functional>

#include "dynamics/integrator.hpp"

namespace pliant {

/// Samples a motion at its own times, without changing it.
struct Observer {
  std::function<double()> next_time;  ///< time of the next sample, s
  /// Called with the state at that time. Returns false if the step need not be taken, because the observer is done.
  std::function<bool()> write;
  /// Whether a sample is due at the end of a step; the caller of the step takes it.
  bool is_due_at(double time) const { return next_time() == time; }
  /// Whether a sample is due within a step that ends at `time`. The end has a tolerance for rounding, which would
  /// otherwise be left for the next step.
  bool is_due_within(double time) const { return next_time() <= time * (1 + 1e-12) && !is_due_at(time); }
};

/// Holds the state after a shorter step, which does not count, during its lifetime, and then restores the state.
class ShorterStep {
 public:
  ShorterStep(const Model& model, State& state, Trial& trial, const StepReport& report)
      : state_(state), trial_(trial), numbers_(state) {
    if (model.scene.cell) work_of_bodies_ = state.body_balance.work;
    take_over(model, state, trial, report);
    state.steps = numbers_.steps, state.rejections = numbers_.rejections, state.evaluations = numbers_.evaluations;
  }
  ~ShorterStep() {
    swap_motion(state_, trial_);
    static_cast<StateNumbers&>(state_) = numbers_;
    if (!work_of_bodies_.empty()) state_.body_balance.work.swap(work_of_bodies_);
  }
  ShorterStep(const ShorterStep&) = delete;
  ShorterStep& operator=(const ShorterStep&) = delete;

 private:
  State& state_;
  Trial& trial_;
  const StateNumbers numbers_;
  std::vector<double> work_of_bodies_;  ///< which a cell with two periods changes
};

enum class Shown { all, enough, failed };

/// Calls an observer, if any, at its times within an attempt, at the ends of shorter steps from the attempt's start,
/// and repeats the attempt. Returns `failed` if a shorter step is not within tolerance.
template <class Scheme>
Shown show_on_the_way(Scheme& scheme, Forces& forces, State& state, const Proposal& proposal,
                      const Observer* observer) {
  if (!observer || !observer->is_due_within(proposal.end_time)) return Shown::all;
  do {
    Proposal shorter = proposal;
    shorter.end_time = observer->next_time(), shorter.dt = shorter.end_time - state.time,
    shorter.is_output_sample = true;
    StepReport report;
    report.dt = shorter.dt;
    scheme.attempt(state, shorter, report);
    if (!scheme.within_tolerance(report)) return Shown::failed;
    scheme.add_damping_work(state, report);
    const ShorterStep step(forces.model(), state, scheme.trial(), report);
    if (!observer->write()) return Shown::enough;
  } while (observer->is_due_within(proposal.end_time));
  StepReport again;
  scheme.attempt(state, proposal, again);
  return Shown::all;
}

}  // namespace pliant
