#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contact/deepest_node.hpp"
#include "core/errors.hpp"
#include "dynamics/trial.hpp"

namespace pliant {

/// What ends a run. Looks at everything again, body by body: for failures only.

struct LeastJacobian {
  double value = 1e300;
  int body = -1, point = 0;  ///< of integration; -1: no compliant bodies
};

struct Failure {
  enum class Cause { inverted, not_finite, contact_lost, not_followed };
  std::string words;
  Cause cause = Cause::not_followed;
  std::vector<int> bodies;    ///< that it is about
  std::optional<int> node;    ///< of the first one: of its outline where contact is lost, else of its field
  std::optional<Vec2> place;  ///< in the last trial, m
  // Of that trial:
  double time = 0, dt = 0, largest_dt = 0, error = 0;
  std::string governed_by;
  // Of the last good state:
  LeastJacobian least_jacobian;
  DeepestNode deepest;
};

/// A run that cannot go on, with more than its message tells.
struct StepFailure : PhysicsError {
  StepFailure(const std::string& message, Failure what) : PhysicsError(message), failure(std::move(what)) {}
  Failure failure;
};

/// Trials that came to nothing.
struct FailedStep {
  const StepReport& report;  ///< of the last trial
  const Trial& trial;
  double next_dt;           ///< what would have to be tried next, s
  double largest_dt;        ///< what limits dt when no error does, s
  std::string governed_by;  ///< and its reason
};

/// Throws StepFailure when next_dt has fallen under 1e-9 of largest_dt: what the last trial met (a grain turned inside
/// out, a number that is none, a lost contact, an error that stays), where and when, what governs the time step and the
/// last good state.
void check_time_step(const FailedStep& step, const State& accepted, const Forces& forces);

/// Throws PhysicsError when the scene cannot start from its initial positions.
void check_start(const Evaluation& evaluation, const State& start, const Forces& forces);

}  // namespace pliant
