#include "dynamics/verlet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodies/initial_state.hpp"
#include "boundary/loads.hpp"
#include "core/errors.hpp"
#include "dynamics/accelerations.hpp"

namespace pliant {
namespace {

constexpr int bound_period = 50;     ///< steps between power iterations
constexpr double first_step = 1e-3;  ///< of the bound
constexpr double least_factor = 0.5, largest_factor = 1.15;
constexpr double exponent = 1.0 / 3.0;  ///< the estimate is of third order in dt

double controller_factor(double error, double tolerance) {
  if (error == 0) return largest_factor;
  return std::clamp(std::pow(tolerance / error, exponent), least_factor, largest_factor);
}

}  // namespace

Verlet::Verlet(Forces& forces, const State& state)
    : forces_(forces), model_(forces.model()), bound_(forces.model(), forces.contact().laws()) {
  trial_.position = trial_.velocity = trial_.force = zero_dofs(model_);
  bound_.update_internal(state.position);
  bound_.update_contact(forces_);
}

StepReport Verlet::step(State& state, double until) {
  const double tolerance = model_.scene.time.tolerance;
  const double largest = std::min(bound_.largest_dt(), model_.scene.time.end);
  if (state.next_dt == 0) state.next_dt = first_step * largest;
  StepReport report;
  for (;;) {
    double dt = std::min(state.next_dt, largest);
    report.governed_by = state.next_dt < largest ? "error" : "stability";
    const double remaining = until - state.time;
    const bool cut = dt >= remaining;
    if (cut)
      dt = remaining, report.governed_by = "output";
    else if (2 * dt > remaining)
      dt = 0.5 * remaining;
    predict(state, dt);
    const double end_time = cut ? until : state.time + dt;
    report.evaluation =
        forces_.evaluate(trial_.position, end_time, state.history, trial_.history, trial_.force, &state.position);
    ++state.evaluations;
    report.error = report.evaluation.sound ? error(state, dt) : std::numeric_limits<double>::infinity();
    const double factor = controller_factor(report.error, tolerance);
    report.dt = dt;
    if (report.error <= 2 * tolerance) {
      forces_.check(report.evaluation, end_time);
      // A step cut short to meet an output says little about the next one.
      state.next_dt =
          std::min(std::max(dt * factor, dt < 0.5 * state.next_dt ? state.next_dt * least_factor : 0.0), largest);
      accept(state, dt, end_time, report.evaluation.contact.dissipated);
      update_bound(state, report.evaluation.refreshed);
      return report;
    }
    ++report.rejections;
    ++state.rejections;
    state.next_dt = dt * std::min(factor, 0.9);
    check_time_step(state.next_dt, largest, report, state.time, forces_);
    if (report.evaluation.refreshed) bound_.update_contact(forces_);
  }
}

void Verlet::predict(const State& state, double dt) {
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
            dof.imposed() ? imposed_position(dof, x, state.time, dt)
                          : x + dt * state.velocity.rigid[i] + half * dof.inverse_mass * state.force.rigid[i];
      });
}

/// max of dt^2 |a_new - a_old| / (6 d) over all components; rigid bodies by their outline nodes.
double Verlet::error(const State& state, double dt) const {
  const double compliant = parallel_max(static_cast<int>(model_.batches.size()), 0, [&](int b) {
    const Batch& batch = model_.batches[b];
    const CompliantShape& shape = model_.shape_of(batch);
    Lanes worst{}, any_nan{};
    for (int i = 0; i < 2 * shape.nodes(); ++i) {
      const std::size_t at = batch.offset + static_cast<std::size_t>(i);
      const double scale = shape.inverse_unit_mass[i / 2] / shape.space.nodal_distance[i / 2];
      const Lanes change = scale * abs(trial_.force.compliant[at] - state.force.compliant[at]);
      worst = max(worst, change);
      any_nan += change;
    }
    const double result = largest(worst * batch.inverse_density);
    return std::isfinite(sum(any_nan)) ? result : std::numeric_limits<double>::infinity();
  });
  double rigid = 0;
  for (std::size_t r = 0; r < model_.rigid_bodies.size(); ++r) {
    const RigidBody& body = model_.rigid_bodies[r];
    const auto change = [&](std::size_t c) {
      return std::abs(trial_.force.rigid[3 * r + c] - state.force.rigid[3 * r + c]) * body.dof[c].inverse_mass;
    };
    const double worst = std::max(change(0), change(1)) + body.max_radius * change(2);
    rigid = std::max(rigid, std::isfinite(worst) ? worst / model_.outlines[body.outline].spacing
                                                 : std::numeric_limits<double>::infinity());
  }
  return dt * dt / 6 * std::max(compliant, rigid);
}

void Verlet::accept(State& state, double dt, double end_time, double dissipated) {
  const double half = 0.5 * dt;
  for_each_dof(
      model_,
      [&](std::size_t i, Lanes inverse_mass) {
        trial_.velocity.compliant[i] =
            state.velocity.compliant[i] + half * inverse_mass * (state.force.compliant[i] + trial_.force.compliant[i]);
      },
      [&](std::size_t i, const RigidDof& dof) {
        trial_.velocity.rigid[i] =
            dof.imposed()
                ? imposed_velocity(dof, state.time + dt)
                : state.velocity.rigid[i] + half * dof.inverse_mass * (state.force.rigid[i] + trial_.force.rigid[i]);
      });
  take_over(model_, state, trial_, end_time, dt, dissipated);
}

void Verlet::update_bound(const State& state, bool refreshed) {
  if (refreshed) bound_.update_contact(forces_);
  if (state.steps % bound_period == 0) bound_.update_internal(state.position);
}

}  // namespace pliant
