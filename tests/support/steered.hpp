#pragma once

#include <memory>

#include "dynamics/energy.hpp"
#include "dynamics/step_doubling.hpp"
#include "dynamics/verlet.hpp"
#include "support/bench.hpp"

namespace pliant::dynamics_tests {

/// A simulation whose steps a test chooses, so that two models can take the same ones.
struct Steered {
  Bench bench;
  Auditor auditor;
  std::unique_ptr<Verlet> verlet;
  std::unique_ptr<StepDoubling> step_doubling;

  explicit Steered(Model model) : bench(std::move(model)), auditor(bench.forces, bench.state) {
    if (bench.model.scene.time.integrator == Integrator::verlet)
      verlet = std::make_unique<Verlet>(bench.forces, bench.state);
    else
      step_doubling = std::make_unique<StepDoubling>(bench.forces, bench.state);
  }

  /// One step of dt, which stability and error must allow.
  StepReport step(double dt) {
    bench.state.next_dt = 1e300;
    const double until = bench.state.time + dt;
    return verlet ? verlet->step(bench.state, until) : step_doubling->step(bench.state, until);
  }
};

}  // namespace pliant::dynamics_tests
