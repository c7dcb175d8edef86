#include "dynamics/integrator.hpp"

#include <utility>

#include <fmt/format.h>

#include "boundary/loads.hpp"
#include "core/errors.hpp"

namespace pliant {

void take_over(const Model& model, State& state, Trial& trial, double end_time, double dt, double dissipated) {
  state.external_work += external_work(model, state.position, trial.position, state.velocity, trial.velocity,
                                       state.force, trial.force, state.time, dt);
  state.dissipated += dissipated;
  std::swap(state.position, trial.position);
  std::swap(state.velocity, trial.velocity);
  std::swap(state.force, trial.force);
  std::swap(state.history, trial.history);
  state.time = end_time;
  ++state.steps;
}

void check_time_step(double dt, double reference, const StepReport& rejected, double time, Forces& forces) {
  constexpr double floor = 1e-9;
  if (dt >= floor * reference) return;
  forces.check(rejected.evaluation, time);
  throw PhysicsError(fmt::format(
      "the time step fell to {:.3g} s, under {:.0e} of {:.3g} s, at t = {:.6g} s (error estimate {:.3g}): "
      "the motion cannot be followed; look at the frames before, and at loads, initial overlaps and stiffness",
      dt, floor, reference, time, rejected.error));
}

}  // namespace pliant
