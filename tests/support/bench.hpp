#pragma once

#include <algorithm>
#include <cmath>

#include "bodies/initial_state.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "dynamics/take_step.hpp"
#include "setup/build_model.hpp"

namespace pliant::dynamics_tests {

/// Model, forces and a state at the start, for tests that drive an integrator by hand. Not to be moved: the parts
/// refer to each other.
struct Bench {
  Model model;
  Forces forces;
  State state;
  StepControl control;

  explicit Bench(const Scene& scene) : Bench(build_model(scene)) {}
  explicit Bench(Model built) : model(std::move(built)), forces(model) {
    state.position = initial_positions(model);
    state.reduced_momentum = initial_velocities(model, state.position);
    state.force = zero_dofs(model);
    state.memory = initial_memory(model);
    evaluate_here();
  }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  /// What a trial at the state's own positions, set by hand, finds; the state keeps its memory.
  Evaluation evaluate(Trial& trial) { return evaluate_at(forces, state, trial); }
  /// Forces there, and the memory that goes with them, become the state's.
  void evaluate_here() { find_forces(forces, state); }

  /// Turns the present shape of body 0 into F X.
  void deform(const Eigen::Matrix2d& F) {
    const Body& body = model.bodies[0];
    Lanes* q = &state.position.compliant[model.batches[body.batch].offset];
    for (int i = 0; i < 2 * model.shape_of(body).nodes(); i += 2) {
      const Vec2 x = F * Vec2(q[i][body.lane], q[i + 1][body.lane]);
      q[i][body.lane] = x.x(), q[i + 1][body.lane] = x.y();
    }
    evaluate_here();
  }
};

/// Largest difference of two states' positions and velocities over the first body of each batch.
inline double distance(const State& a, const State& b) {
  double largest_difference = 0;
  for (std::size_t i = 0; i < a.position.compliant.size(); ++i)
    largest_difference =
        std::max({largest_difference, std::abs(a.position.compliant[i][0] - b.position.compliant[i][0]),
                  std::abs(a.reduced_momentum.compliant[i][0] - b.reduced_momentum.compliant[i][0])});
  return largest_difference;
}

}  // namespace pliant::dynamics_tests
