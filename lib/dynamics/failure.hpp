#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contact/deepest_node.hpp"
#include "core/errors.hpp"
#include "dynamics/trial.hpp"

namespace pliant {

/// Diagnosis of the end of a run. It examines all bodies again: for failures only.

struct LeastJacobian {
  double value = 1e300;
  int body = -1, point = 0;  ///< index of the integration point; -1: no compliant bodies
};

struct Failure {
  enum class Cause { inverted, not_finite, contact_lost, not_followed };
  std::string words;
  Cause cause = Cause::not_followed;
  std::vector<int> bodies;    ///< bodies concerned
  std::optional<int> node;    ///< node of the first body: of its outline if contact is lost, else of its field
  std::optional<Vec2> place;  ///< position in the last trial, m
  // Of that trial:
  double time = 0, dt = 0, largest_dt = 0, error = 0;
  std::string governed_by;
  // Of the last good state:
  LeastJacobian least_jacobian;
  DeepestNode deepest;
};

/// A run that cannot continue, with details beyond its message.
struct StepFailure : PhysicsError {
  StepFailure(const std::string& message, Failure what) : PhysicsError(message), failure(std::move(what)) {}
  Failure failure;
};

/// Step whose trials were all rejected.
struct FailedStep {
  const StepReport& report;  ///< of the last trial
  const Trial& trial;
  double next_dt;           ///< next step size to be tried, s
  double largest_dt;        ///< limit of dt apart from errors, s
  std::string governed_by;  ///< name of the limiting body or criterion
};

/// Throws StepFailure if next_dt has fallen below 1e-9 of largest_dt. The failure tells the cause of the last rejection
/// (an inverted grain, a value that is not finite, a lost contact, a persistent error), place and time, the limit of
/// the time step, and the last valid state.
void check_time_step(const FailedStep& step, const State& accepted, const Forces& forces);

/// Throws PhysicsError if the scene cannot start from its initial positions.
void check_start(const Evaluation& evaluation, const State& start, const Forces& forces);

}  // namespace pliant
