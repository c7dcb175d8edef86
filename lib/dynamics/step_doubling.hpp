#pragma once

#include "dynamics/integrator.hpp"

namespace pliant {

/// The paper's scheme (METHOD 6): semi-implicit Euler once with dt (u1) and twice with dt/2 (u2, kept), controlled by
/// err = max |u2 - u1| / d over all field nodes and rigid outline nodes. Two force evaluations a step. It knows no stability limit. Loads act with their
/// mean over each half step, forces that depend on velocities see those of its start.
class StepDoubling {
 public:
  StepDoubling(Forces& forces, const State& state);

  /// Takes one accepted step that ends at `until` at the latest.
  StepReport step(State& state, double until);
  template <class Visitor>
  void visit(Visitor&&) {}  ///< nothing outlives a step

 private:
  double try_step(State& state, double end_time, StepReport& report, bool once_more = true);
  void find_start_force(const State& state, double half);
  bool evaluate(State& state, const Instant& at, ContactHistory& from, ContactHistory& to, StepReport& report);
  void half_step(const Dofs& position, const Dofs& velocity, const Dofs& force, double time, double half);
  double error(const State& state, double dt);
  void find_difference(const Region& region, double dt);
  void correct_difference();
  double region_error(const Region& region) const;
  double rigid_error(std::size_t rigid, const State& state, double dt) const;

  Forces& forces_;
  const Model& model_;
  const bool drag_;                ///< something meets it
  double wave_time_;               ///< from node to node, s
  Dofs moving_velocity_;           ///< with corrected mass only: C y
  Dofs start_force_;               ///< of the first half step
  Trial trial_;                    ///< at the half step, then at the end
  double trial_time_ = 0;          ///< of the trial's last evaluation, s
  ContactHistory half_history_;    ///< at the half step
  std::vector<Lanes> difference_;  ///< u2 - u1 of the compliant degrees of freedom
};

}  // namespace pliant
