#include "dynamics/verlet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodies/initial_state.hpp"
#include "bodies/mass_correction.hpp"
#include "boundary/loads.hpp"
#include "dynamics/accelerations.hpp"
#include "dynamics/failure.hpp"

namespace pliant {
namespace {

constexpr int bound_period = 50;     ///< steps between power iterations
constexpr double first_step = 1e-3;  ///< of the bound
constexpr double least_factor = 0.5, largest_factor = 1.15;
constexpr double exponent = 1.0 / 3.0;  ///< the estimate is of third order in dt
/// A step that follows each error up and down, in time with the fastest vibrations, damps them (docs/defaults.md). So a large error fades from
/// memory over many of their periods only.
constexpr double fading = 0.99;

double controller_factor(double error, double tolerance) {
  if (error == 0) return largest_factor;
  return std::clamp(std::pow(tolerance / error, exponent), least_factor, largest_factor);
}

}  // namespace

Verlet::Verlet(Forces& forces, const State& state)
    : forces_(forces), model_(forces.model()), bound_(forces.model(), forces.contact().laws()) {
  trial_.position = trial_.velocity = trial_.force = zero_dofs(model_);
  change_.resize(model_.regions.size());
  bound_.update_internal(state.position);
  bound_.update_contact(forces_);
}

StepReport Verlet::step(State& state, double until) {
  const double tolerance = model_.scene.time.tolerance;
  double next_dt = state.next_dt > 0 ? state.next_dt : first_step * largest_dt();
  StepReport report;
  for (;;) {
    const double largest = largest_dt();  // a rejected trial may have found new contacts
    const double wish = std::min(next_dt, largest);
    // Equal steps up to the next output: a short one before each would jolt the fastest vibrations time and again.
    const double remaining = until - state.time, steps = std::max(1.0, std::ceil(remaining / wish));
    const double dt = report.dt = remaining / steps;
    const double end_time = steps > 1 ? state.time + dt : until;
    report.governed_by = steps == 1 ? "output" : next_dt < largest ? "error" : "stability";
    try_step(state, end_time, report);
    if (report.error <= 2 * tolerance) {
      forces_.warn_of_depth(report.evaluation, end_time);
      state.jerk = std::max(report.error / (dt * dt * dt), fading * state.jerk);
      // Of the whole step: one cut short to meet an output does not slow the run down.
      next_dt = std::min(wish * controller_factor(state.jerk * wish * wish * wish, tolerance), largest);
      accept(state, end_time, next_dt, report);
      return report;
    }
    next_dt = dt * controller_factor(report.error, tolerance);
    ++report.rejections;
    check_time_step({report, trial_, end_time, next_dt, largest, bound_.governing()}, state, forces_);
  }
}

double Verlet::largest_dt() const { return std::min(bound_.largest_dt(), model_.scene.time.end); }

void Verlet::try_step(State& state, double end_time, StepReport& report) {
  predict(state, report.dt);
  report.evaluation = forces_.evaluate({trial_.position, half_step_velocity(), end_time}, state.history, trial_.history,
                                       trial_.force, &state, [&](int r) { finish_region(state, report.dt, r); });
  report.damping_work = report.dt * report.evaluation.damping_power;
  ++report.evaluations;
  if (report.evaluation.refreshed) bound_.update_contact(forces_);
  report.error = report.evaluation.sound ? error(state, report.dt) : std::numeric_limits<double>::infinity();
}

/// Positions at the end of the step. Forces that depend on velocities see those of the half step, by which the positions move.
void Verlet::predict(const State& state, double dt) {
  if (model_.rates || model_.corrected_mass) {
    predict_half_step_velocity(state, dt);
    return move_by_half_step_velocity(state, dt);
  }
  const double half = 0.5 * dt * dt;
  for_each_dof(
      model_,
      [&](std::size_t i, Lanes inverse_mass) {
        trial_.position.compliant[i] = state.position.compliant[i] + dt * state.velocity.compliant[i] +
                                       half * inverse_mass * state.force.compliant[i];
      },
      [&](std::size_t i, const RigidDof& dof) {
        const double x = state.position.rigid[i];
        trial_.position.rigid[i] =
            dof.imposed(state.time) ? imposed_position(dof, x, state.time, dt)
                                    : x + dt * state.velocity.rigid[i] + half * dof.inverse_mass * state.force.rigid[i];
      });
}

void Verlet::predict_half_step_velocity(const State& state, double dt) {
  for_each_dof(
      model_,
      [&](std::size_t i, Lanes inverse_mass) {
        trial_.velocity.compliant[i] = state.velocity.compliant[i] + 0.5 * dt * inverse_mass * state.force.compliant[i];
      },
      [&](std::size_t i, const RigidDof& dof) {
        trial_.velocity.rigid[i] = dof.imposed(state.time)
                                       ? imposed_velocity(dof, state.time + 0.5 * dt)
                                       : state.velocity.rigid[i] + 0.5 * dt * dof.inverse_mass * state.force.rigid[i];
      });
  if (model_.corrected_mass) half_step_velocity_ = material_velocity(model_, trial_.velocity);
}

void Verlet::move_by_half_step_velocity(const State& state, double dt) {
  const Dofs& velocity = half_step_velocity();
  for_each_dof(
      model_,
      [&](std::size_t i, Lanes) {
        trial_.position.compliant[i] = state.position.compliant[i] + dt * velocity.compliant[i];
      },
      [&](std::size_t i, const RigidDof& dof) {
        const double x = state.position.rigid[i];
        trial_.position.rigid[i] =
            dof.imposed(state.time) ? imposed_position(dof, x, state.time, dt) : x + dt * velocity.rigid[i];
      });
}

/// Velocities at the end of the step, and the largest |a_new - a_old| / d. It is done here, before the step is accepted, because the forces come
/// out of the cache then.
void Verlet::finish_region(const State& state, double dt, int r) {
  const Region& region = model_.regions[r];
  const Batch& batch = model_.batches[region.batch];
  const Lanes *old_force = &state.force.compliant[batch.offset], *force = &trial_.force.compliant[batch.offset];
  const Lanes* old_velocity = &state.velocity.compliant[batch.offset];
  Lanes* velocity = &trial_.velocity.compliant[batch.offset];
  const Lanes upper_inverse_density =
      with_tables(model_, batch, [&](const auto& tables) { return tables.correction_bound * batch.inverse_density; });
  with_nodes(model_, batch, [&](const auto& nodes) {
    Lanes worst{}, any_nan{};
    for (int i = 2 * region.first; i < 2 * region.last; ++i) {
      const auto inverse_unit_mass = nodes.inverse_unit_mass[i / 2];
      velocity[i] =
          old_velocity[i] + 0.5 * dt * (inverse_unit_mass * batch.inverse_density) * (old_force[i] + force[i]);
      const Lanes change = inverse_unit_mass / nodes.nodal_distance[i / 2] * abs(force[i] - old_force[i]);
      worst = max(worst, change);
      any_nan += change;
    }
    const double result = largest(worst * upper_inverse_density);
    change_[r] = std::isfinite(sum(any_nan)) ? result : std::numeric_limits<double>::infinity();
  });
}

/// max of dt^2 |a_new - a_old| / (6 d) over all components; rigid bodies by their outline nodes.
double Verlet::error(const State& state, double dt) const {
  double compliant = 0;
  for (double change : change_) compliant = std::max(compliant, change);
  double rigid = 0;
  for (std::size_t r = 0; r < model_.rigid_bodies.size(); ++r) {
    const RigidBody& body = model_.rigid_bodies[r];
    const auto change = [&](std::size_t c) {
      if (body.dof[c].imposed(state.time)) return 0.0;
      return std::abs(trial_.force.rigid[3 * r + c] - state.force.rigid[3 * r + c]) * body.dof[c].inverse_mass;
    };
    const double worst = std::max(change(0), change(1)) + body.max_radius * change(2);
    rigid = std::max(rigid, std::isfinite(worst) ? worst / model_.outlines[body.outline].spacing
                                                 : std::numeric_limits<double>::infinity());
  }
  return dt * dt / 6 * std::max(compliant, rigid);
}

void Verlet::accept(State& state, double end_time, double next_dt, const StepReport& report) {
  const double half = 0.5 * report.dt;
  for_each_rigid_dof(model_, [&](std::size_t i, const RigidDof& dof) {
    trial_.velocity.rigid[i] =
        dof.imposed(state.time)
            ? imposed_velocity(dof, end_time)
            : state.velocity.rigid[i] + half * dof.inverse_mass * (state.force.rigid[i] + trial_.force.rigid[i]);
  });
  take_over(model_, state, trial_, end_time, next_dt, report);
  if (state.steps % bound_period == 0) bound_.update_internal(state.position);
}

}  // namespace pliant
