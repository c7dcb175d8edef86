#pragma once

#include <string>

#include "dynamics/trial.hpp"

namespace pliant {

/// What ends a run, in words. Looks at everything again, body by body: for failures only.

/// Trials that came to nothing.
struct FailedStep {
  const StepReport& report;  ///< of the last trial
  const Trial& trial;
  double next_dt;           ///< what would have to be tried next, s
  double largest_dt;        ///< what limits dt when no error does, s
  std::string governed_by;  ///< and its reason
};

/// Throws PhysicsError when next_dt has fallen under 1e-9 of largest_dt: what the last trial met (a grain turned inside
/// out, a number that is none, a lost contact, an error that stays), where and when, what governs the time step and the
/// last good state.
void check_time_step(const FailedStep& step, const State& accepted, const Forces& forces);

/// Throws PhysicsError when the scene cannot start from its initial positions.
void check_start(const Evaluation& evaluation, const State& start, const Forces& forces);

}  // namespace pliant
