#include "dynamics/integrator.hpp"

#include <fmt/format.h>

#include "core/errors.hpp"

namespace pliant {

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
