#pragma once

#include <concepts>

#include "dynamics/failure.hpp"
#include "dynamics/observer.hpp"

namespace pliant {

/// Interface of an integrator. `add_damping_work` also follows output samples; only `accepted` is for accepted steps
/// alone.
template <class S>
concept StepScheme = requires(S& scheme, const S& fixed, State& state, const StepControl& control,
                              const Proposal& proposal, StepReport& report) {
  { fixed.first_dt() } -> std::same_as<double>;                  // s
  { fixed.propose(state, 0.0, 0.0) } -> std::same_as<Proposal>;  // from next_dt and `until`
  { scheme.attempt(state, proposal, report) };                   // fills the trial, not the state
  { fixed.within_tolerance(report) } -> std::same_as<bool>;
  { fixed.judge(state, control, proposal, report) } -> std::same_as<Verdict>;
  { scheme.add_damping_work(state, report) };  // dissipation of the step
  { scheme.accepted(state, report) };          // after the trial became the state
  { scheme.trial() } -> std::same_as<Trial&>;
  { fixed.governing() } -> std::convertible_to<std::string>;  // body that limits the step
};

/// One accepted step that ends at `until` at the latest, for any scheme: it proposes, attempts, judges and finishes. An
/// observer, if any, sees its samples within the step. The step does not depend on it, with two exceptions. If the
/// observer is done, no step is taken, and the report has dt = 0. If a sample is not within tolerance, the step ends at
/// the sample.
template <StepScheme Scheme>
StepReport take_step(Scheme& scheme, Forces& forces, State& state, StepControl& control, double until,
                     const Observer* observer = nullptr) {
  double next_dt = control.next_dt > 0 ? control.next_dt : scheme.first_dt();
  StepReport report;
  for (;;) {
    const Proposal proposal = scheme.propose(state, next_dt, until);
    report.dt = proposal.dt;
    report.limited_by = proposal.limited_by;
    scheme.attempt(state, proposal, report);
    if (scheme.within_tolerance(report)) {
      const Shown shown = show_on_the_way(scheme, forces, state, proposal, observer);
      if (shown == Shown::enough) return {};
      if (shown == Shown::failed) {
        until = observer->next_time();  // with a step of its own, which may be rejected
        continue;
      }
    }
    const Verdict verdict = scheme.judge(state, control, proposal, report);
    if (verdict.accepted) {
      control = verdict.control;
      break;
    }
    next_dt = verdict.control.next_dt;
    ++report.rejections;
    check_time_step({report, scheme.trial(), next_dt, proposal.largest_dt, scheme.governing()}, state, forces);
  }
  forces.warn_of_depth(report.evaluation, scheme.trial().time);
  scheme.add_damping_work(state, report);
  take_over(forces.model(), state, scheme.trial(), report);
  scheme.accepted(state, report);
  return report;
}

}  // namespace pliant
