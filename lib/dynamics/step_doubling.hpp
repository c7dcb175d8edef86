#pragma once

#include "dynamics/integrator.hpp"

namespace pliant {

/// The paper's scheme (METHOD 6): semi-implicit Euler once with dt (u1) and twice with dt/2 (u2, kept), controlled by
/// err = max |u2 - u1| / d over all field nodes and rigid outline nodes. Two force evaluations a step. It knows no stability limit.
class StepDoubling {
 public:
  StepDoubling(Forces& forces, const State& state);

  /// Takes one accepted step that ends at `until` at the latest.
  StepReport step(State& state, double until);

 private:
  void half_step(const State& state, double dt);
  void second_half_step(const State& state, double dt);
  double error(const State& state, double dt) const;
  double batch_error(const Batch& batch) const;
  double rigid_error(std::size_t rigid, const State& state, double dt) const;
  void accept(State& state, double dt, double end_time, Evaluation& evaluation);

  Forces& forces_;
  const Model& model_;
  double wave_time_;               ///< from node to node, s
  Trial trial_;                    ///< at the half step, then at the end
  std::vector<Lanes> difference_;  ///< u2 - u1 of the compliant degrees of freedom, dt^2/4 a_half - dt^2/2 a_start
};

}  // namespace pliant
