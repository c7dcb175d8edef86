#pragma once

#include "dynamics/forces.hpp"

namespace pliant {

/// Motion of a trial and its forces, which become the state's when the step is accepted.
struct Trial {
  double time = 0;  ///< time of the last evaluation, s
  Dofs position, reduced_momentum, force;
  Memory memory;
  Outlines outlines;
  OutlineField contact_force;

  explicit Trial(const Model& model);
};

/// The reason for the length of a step: the error estimate, the bound of stability, or a time at which it must end.
enum class StepLimit { error, stability, until };
inline const char* name_of(StepLimit limit) {
  return limit == StepLimit::error ? "error" : limit == StepLimit::stability ? "stability" : "until";
}

/// One accepted step, or the trials so far.
struct StepReport {
  double dt = 0, error = 0;
  double damping_work = 0;  ///< dissipated by forces that depend on velocities, J/m
  int rejections = 0, evaluations = 0;
  Evaluation evaluation;  ///< the last one
  StepLimit limited_by = StepLimit::until;
};

}  // namespace pliant
