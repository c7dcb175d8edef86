#pragma once

#include "dynamics/integrator.hpp"
#include "dynamics/time_step_bound.hpp"

namespace pliant {

/// Velocity Verlet with a stability bound and a free error control (METHOD 6): one force evaluation a step.
class Verlet {
 public:
  Verlet(Forces& forces, const State& state);

  /// Takes one accepted step that ends at `until` at the latest.
  StepReport step(State& state, double until);
  const TimeStepBound& bound() const { return bound_; }

 private:
  void predict(const State& state, double dt);
  double error(const State& state, double dt) const;
  void accept(State& state, double dt, double end_time, double dissipated);
  void update_bound(const State& state, bool refreshed);

  Forces& forces_;
  const Model& model_;
  TimeStepBound bound_;
  Trial trial_;
};

}  // namespace pliant
