#pragma once

#include "dynamics/forces.hpp"

namespace pliant {

/// A motion under trial and the forces that it meets: they become the state's own when the step is accepted.
struct Trial {
  double time = 0;  ///< of the last evaluation, s
  Dofs position, reduced_momentum, force;
  Memory memory;
  Outlines outlines;
  OutlineField contact_force;

  explicit Trial(const Model& model);
};

/// One accepted step, or the trials so far.
struct StepReport {
  double dt = 0, error = 0;
  double damping_work = 0;  ///< dissipated by forces that depend on velocities, J/m
  int rejections = 0, evaluations = 0;
  Evaluation evaluation;         ///< the last one
  const char* governed_by = "";  ///< as in Proposal
};

}  // namespace pliant
