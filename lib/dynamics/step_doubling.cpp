#include "dynamics/step_doubling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodies/initial_state.hpp"
#include "boundary/loads.hpp"
#include "dynamics/accelerations.hpp"

namespace pliant {
namespace {

/// The controller's factor on dt: clamped, because the error may vanish or explode.
constexpr double least_factor = 0.2, largest_factor = 2;
constexpr double first_step = 1e-3;  ///< of the time a wave takes from node to node

/// Least nodal distance over wave speed: a scale for the first step and the floor, not a limit.
double wave_time(const Model& model) {
  double result = model.scene.time.end;
  for (const Batch& batch : model.batches) {
    const std::vector<double>& distance = model.shape_of(batch).space.nodal_distance;
    const double least = *std::min_element(distance.begin(), distance.end());
    result = std::min(result, least * std::sqrt(batch.density[0] / (batch.lambda[0] + 2 * batch.mu[0])));
  }
  return result;
}

}  // namespace

StepDoubling::StepDoubling(Forces& forces, const State&)
    : forces_(forces), model_(forces.model()), wave_time_(wave_time(model_)) {
  trial_.position = trial_.velocity = trial_.force = zero_dofs(model_);
  difference_.resize(model_.compliant_size);
}

StepReport StepDoubling::step(State& state, double until) {
  const TimeSettings& settings = model_.scene.time;
  if (state.next_dt == 0) state.next_dt = first_step * wave_time_;
  StepReport report;
  for (;;) {
    const double remaining = until - state.time;
    const bool cut = state.next_dt >= remaining;
    const double dt = cut ? remaining : state.next_dt;
    report.governed_by = cut ? "output" : "error";
    half_step(state, dt);
    report.evaluation = forces_.evaluate(trial_.position, state.time + 0.5 * dt, state.history, trial_.history,
                                         trial_.force, &state.position);
    ++state.evaluations;
    second_half_step(state, dt);
    report.error = report.evaluation.sound ? error(state, dt) : std::numeric_limits<double>::infinity();
    report.dt = dt;
    const double factor = report.error > 0 ? std::pow(report.error / settings.target, -settings.beta) : largest_factor;
    const double proposal = dt * std::clamp(factor, least_factor, largest_factor);
    if (report.error <= settings.alpha * settings.target) {
      state.next_dt = cut ? std::max(proposal, state.next_dt) : proposal;
      accept(state, dt, cut ? until : state.time + dt, report.evaluation);
      return report;
    }
    state.next_dt = proposal;
    ++report.rejections;
    ++state.rejections;
    check_time_step(state.next_dt, wave_time_, report, state.time, forces_);
  }
}

/// v_half = v + dt/2 a, u_half = u + dt/2 v_half, into trial.
void StepDoubling::half_step(const State& state, double dt) {
  const double half = 0.5 * dt;
  for_each_dof(
      model_,
      [&](std::size_t i, Lanes inverse_mass) {
        trial_.velocity.compliant[i] = state.velocity.compliant[i] + half * inverse_mass * state.force.compliant[i];
        trial_.position.compliant[i] = state.position.compliant[i] + half * trial_.velocity.compliant[i];
      },
      [&](std::size_t i, const RigidDof& dof) {
        trial_.velocity.rigid[i] = dof.imposed()
                                       ? imposed_velocity(dof, state.time + half)
                                       : state.velocity.rigid[i] + half * dof.inverse_mass * state.force.rigid[i];
        trial_.position.rigid[i] = dof.imposed() ? imposed_position(dof, state.position.rigid[i], state.time, half)
                                                 : state.position.rigid[i] + half * trial_.velocity.rigid[i];
      });
}

/// v2 = v_half + dt/2 a_half, u2 = u_half + dt/2 v2; u2 - u1 = dt^2/4 a_half - dt^2/2 a.
void StepDoubling::second_half_step(const State& state, double dt) {
  const double half = 0.5 * dt;
  for_each_dof(
      model_,
      [&](std::size_t i, Lanes inverse_mass) {
        const Lanes a = inverse_mass * state.force.compliant[i], a_half = inverse_mass * trial_.force.compliant[i];
        trial_.velocity.compliant[i] += half * a_half;
        trial_.position.compliant[i] += half * trial_.velocity.compliant[i];
        difference_[i] = (half * half) * (a_half - 2.0 * a);
      },
      [&](std::size_t i, const RigidDof& dof) {
        trial_.velocity.rigid[i] = dof.imposed()
                                       ? imposed_velocity(dof, state.time + dt)
                                       : trial_.velocity.rigid[i] + half * dof.inverse_mass * trial_.force.rigid[i];
        trial_.position.rigid[i] = dof.imposed() ? imposed_position(dof, state.position.rigid[i], state.time, dt)
                                                 : trial_.position.rigid[i] + half * trial_.velocity.rigid[i];
      });
}

/// Displacements are u = sum phi U, at the field nodes.
double StepDoubling::batch_error(const Batch& batch) const {
  const Discretisation& space = model_.shape_of(batch).space;
  const ShapeRows& rows = space.node_rows;
  const Lanes* d = &difference_[batch.offset];
  Lanes worst{}, any_nan{};
  for (std::size_t k = 0; k + 1 < rows.start.size(); ++k) {
    Lanes x{}, y{};
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e) {
      x += rows.value[e] * d[2 * rows.node[e]];
      y += rows.value[e] * d[2 * rows.node[e] + 1];
    }
    const Lanes here = max(abs(x), abs(y)) * (1 / space.nodal_distance[k]);
    worst = max(worst, here);
    any_nan += x + y;
  }
  return std::isfinite(sum(any_nan)) ? largest(worst) : std::numeric_limits<double>::infinity();
}

/// Componentwise difference of the outline nodes between the two ends u1 and u2.
double StepDoubling::rigid_error(std::size_t r, const State& state, double dt) const {
  const RigidBody& body = model_.rigid_bodies[r];
  double change[3], end[3];
  for (std::size_t c = 0; c < 3; ++c) {
    const RigidDof& dof = body.dof[c];
    const double a = dof.inverse_mass * state.force.rigid[3 * r + c],
                 a_half = dof.inverse_mass * trial_.force.rigid[3 * r + c];
    change[c] = dof.imposed() ? 0.0 : 0.25 * dt * dt * (a_half - 2 * a);
    end[c] = trial_.position.rigid[3 * r + c];
  }
  const double c2 = std::cos(end[2]), s2 = std::sin(end[2]), c1 = std::cos(end[2] - change[2]),
               s1 = std::sin(end[2] - change[2]);
  double worst = 0;
  for (const Vec2& p : model_.outlines[body.outline].points) {
    const double dx = change[0] + (c2 - c1) * p.x() - (s2 - s1) * p.y(),
                 dy = change[1] + (s2 - s1) * p.x() + (c2 - c1) * p.y();
    worst = std::max({worst, std::abs(dx), std::abs(dy)});
  }
  if (!std::isfinite(change[0] + change[1] + change[2])) return std::numeric_limits<double>::infinity();
  return worst / model_.outlines[body.outline].spacing;
}

double StepDoubling::error(const State& state, double dt) const {
  const double compliant =
      parallel_max(static_cast<int>(model_.batches.size()), 0, [&](int b) { return batch_error(model_.batches[b]); });
  return parallel_max(static_cast<int>(model_.rigid_bodies.size()), compliant,
                      [&](int r) { return rigid_error(static_cast<std::size_t>(r), state, dt); });
}

/// Keeps u2 and evaluates the forces there, which the next step starts from.
void StepDoubling::accept(State& state, double dt, double end_time, Evaluation& evaluation) {
  std::swap(state.history, trial_.history);
  state.dissipated += evaluation.contact.dissipated;
  evaluation = forces_.evaluate(trial_.position, end_time, state.history, trial_.history, trial_.force);
  forces_.check(evaluation, end_time);
  ++state.evaluations;
  take_over(model_, state, trial_, end_time, dt, evaluation.contact.dissipated);
}

}  // namespace pliant
