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
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("bound", bound_);
  }

 private:
  void try_step(State& state, double end_time, StepReport& report);
  void predict(const State& state, double dt);
  void move_by_half_step_velocity(const State& state, double dt);
  void predict_half_step_velocity(const State& state, double dt);
  void finish_region(const State& state, double dt, int r);
  double error(const State& state, double dt) const;
  void accept(State& state, double end_time, double next_dt, const StepReport& report);
  double largest_dt() const;
  const Dofs& half_step_velocity() const { return model_.corrected_mass ? half_step_velocity_ : trial_.velocity; }

  Forces& forces_;
  const Model& model_;
  TimeStepBound bound_;
  Trial trial_;
  Dofs half_step_velocity_;     ///< with corrected mass only: C y
  std::vector<double> change_;  ///< [regions], of the acceleration over the nodal distance, 1/s2
};

}  // namespace pliant
