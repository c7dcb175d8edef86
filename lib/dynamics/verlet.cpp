#include "dynamics/verlet.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "bodies/damping_forces.hpp"
#include "bodies/for_each_dof.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "boundary/loads.hpp"
#include "contact/halo.hpp"
#include "dynamics/cell_motion.hpp"
#include "dynamics/mass_damping.hpp"

namespace pliant {
namespace {

constexpr int bound_period = 50;     ///< steps between power iterations
constexpr double first_step = 1e-3;  ///< of the stability bound
constexpr double least_factor = 0.5, largest_factor = 1.15;
constexpr double exponent = 1.0 / 3.0;  ///< the estimate is of third order in dt
/// Steps that follow each error up and down, in phase with the fastest vibrations, damp these (docs/defaults.md).
/// Therefore the largest error of this span of steps and the one before counts, which is many of their periods.
constexpr int span = 64;
/// Steps shorter than this share of the controller's step do not enter the error history. Equalised steps before a stop
/// are never that short.
constexpr double least_step_share = 0.5;

double controller_factor(double error, double tolerance) {
  if (error <= 1e-3 * tolerance) return largest_factor;  // the ratio may overflow
  return std::clamp(std::pow(tolerance / error, exponent), least_factor, largest_factor);
}

}  // namespace

Verlet::Verlet(Forces& forces, const State& state)
    : forces_(forces),
      model_(forces.model()),
      has_mass_damping_(has_mass_damping(forces.model())),
      damping_loss_(forces.model()),
      needs_velocities_(has_mass_damping_ || model_.rates),
      bound_(forces.model(), forces.contact().laws()),
      body_correction_(model_),
      trial_(model_),
      mean_velocity_(needs_velocities_ ? zero_dofs(model_) : Dofs()),
      end_velocity_(needs_velocities_ ? zero_dofs(model_) : Dofs()),
      change_(model_.regions.size() + model_.rigid_bodies.size()) {
  bound_.update_internal(state.position, state.memory);
  bound_.update_contact(forces_.contact(), forces_.bonds());
}

double Verlet::first_dt() const { return first_step * std::min(largest_dt(), model_.scene.time.end); }

/// Divides the time to the next stop, such as a point of a history, into equal steps. One short step before each stop
/// would excite the fastest vibrations again and again.
Proposal Verlet::propose(const State& state, double next_dt, double until) const {
  const double largest = std::min(largest_dt(), model_.scene.time.end), controller_dt = std::min(next_dt, largest);
  const double remaining = until - state.time, steps = std::max(1.0, std::ceil(remaining / controller_dt));
  const double dt = std::isfinite(steps) ? remaining / steps : controller_dt;
  return {dt, steps > 1 ? state.time + dt : until, controller_dt, largest,
          steps == 1          ? StepLimit::until
          : next_dt < largest ? StepLimit::error
                              : StepLimit::stability};
}

void Verlet::attempt(State& state, const Proposal& proposal, StepReport& report) {
  trial_.time = proposal.end_time;
  predict(state, proposal.dt);
  const Motion motion{trial_.position, end_velocity_, proposal.end_time, true};
  forces_.phases().enter(Phase::outlines);
  update_outlines(model_, motion, trial_.outlines);
  if (model_.halo)
    model_.halo->exchange({state.position, state.force, state.outlines},
                          {trial_.position, trial_.force, trial_.outlines});
  Forces::ListCheck candidates;
  if (!proposal.is_output_sample)
    candidates = forces_.ensure_candidates(state, trial_.outlines.position, proposal.end_time);
  if (candidates.rebuilt)
    forces_.phases().apart(Phase::bound, [&] { bound_.update_contact(forces_.contact(), forces_.bonds()); });
  report.evaluation = forces_and_velocities(state, motion, proposal.dt);
  report.evaluation.valid &= candidates.valid;
  ++report.evaluations;
  report.error = report.evaluation.valid ? error(proposal.dt) : std::numeric_limits<double>::infinity();
  if (model_.halo) report.error = model_.halo->largest(report.error);
}

/// Fused kernel (Forces::evaluate_and_update): all forces at the end of the step, then update_region and update_rigid
/// for the velocities there.
Evaluation Verlet::forces_and_velocities(const State& state, const Motion& motion, double dt) {
  const PreviousHistory from{state.memory, dt, &state.outlines.position, rigid_steps(state)};
  const auto of_region = [&](int r) { update_region(state, dt, r); };
  const auto of_rigid = [&](int r) { update_rigid(state, dt, r); };
  return forces_.evaluate_and_update(motion, trial_.outlines, from, {trial_.force, trial_.contact_force, trial_.memory},
                                     {std::cref(of_region), std::cref(of_rigid)});
}

Verdict Verlet::judge(const State& state, const StepControl& control, const Proposal& proposal,
                      const StepReport& report) const {
  const double tolerance = model_.scene.time.tolerance, dt = proposal.dt, controller_dt = proposal.controller_dt;
  if (!within_tolerance(report)) return {false, {dt * controller_factor(report.error, tolerance)}};
  StepControl next = control;
  if (state.steps % span == 0) next.jerk_before = std::exchange(next.jerk, 0);
  // Of the whole step: one cut short to meet a stop does not slow the run down, nor does what it saw of a load that
  // changes as shortly.
  if (dt >= least_step_share * controller_dt) next.jerk = std::max(report.error / (dt * dt * dt), next.jerk);
  const double jerk = std::max(next.jerk, next.jerk_before);
  const double next_dt =
      controller_dt * controller_factor(jerk * controller_dt * controller_dt * controller_dt, tolerance);
  next.next_dt = std::min(next_dt, proposal.largest_dt);
  return {true, next};
}

/// Motion of rigid bodies in the step, for the energy correction of contacts. Accelerations differ between the end of
/// the previous step and the start of this one where a load jumps, or where an imposed motion begins or ends.
const RigidStep* Verlet::rigid_steps(const State& state) {
  if (!model_.scene.corrects_energy()) return nullptr;
  rigid_steps_.resize(model_.rigid_bodies.size());
  const bool jumps = std::ranges::binary_search(model_.switch_times, state.time);
  if (jumps) {  // the change of the loads, in the force of the trial, which is not known yet
    std::ranges::fill(trial_.force.rigid, 0.0);
    const Dofs& velocity = material_velocity(model_, state.reduced_momentum, moving_velocity_);
    add_load_change(model_, {state.position, velocity, state.time, true}, state.outlines, {state.time}, trial_.force);
  }
  const double just_before = std::nextafter(state.time, -std::numeric_limits<double>::infinity());
  const auto set_step = [&](int r) {
    const double *from = &state.position.rigid[3 * r], *to = &trial_.position.rigid[3 * r];
    RigidStep& step = rigid_steps_[r] = {{from[0], from[1]}, {to[0], to[1]}, to[2] - from[2], {}, {}};
    for (std::size_t c = 0; c < 3; ++c) {
      const RigidDof& dof = model_.rigid_bodies[r].dof[c];
      const double force = state.force.rigid[3 * r + c];
      step.acceleration[c] = dof.inverse_mass_at(state.time) * force;
      step.acceleration_before[c] =
          dof.inverse_mass_at(just_before) * (jumps ? force - trial_.force.rigid[3 * r + c] : force);
    }
  };
  const std::vector<int>& own = model_.own.rigid_bodies;
  parallel_for(static_cast<int>(own.size()), [&](int number) { set_step(own[number]); });
  if (model_.halo)
    for (int r : model_.halo->rigid_ghosts()) set_step(r);
  return rigid_steps_.data();
}

/// Predicts positions at the end of the step and, for forces that depend on them, velocities there.
void Verlet::predict(const State& state, double dt) {
  trial_.position.lattice = state.position.lattice + dt * state.reduced_momentum.lattice;
  trial_.reduced_momentum.lattice = end_velocity_.lattice = state.reduced_momentum.lattice;
  if (needs_velocities_) {
    predict_velocities(state, dt);
    return move_by_mean_velocity(state, dt);
  }
  const double half = 0.5 * dt * dt;
  const auto move_rigid = [&](std::size_t i, const RigidDof& dof) {
    const double x = state.position.rigid[i],
                 free = x + dt * state.reduced_momentum.rigid[i] + half * dof.inverse_mass * state.force.rigid[i];
    trial_.position.rigid[i] = dof.position_after(state.time, dt, x, free);
  };
  if (model_.has_reciprocal_mass) {
    move_by_momenta(state, dt, half);
    const std::vector<int>& own = model_.own.rigid_bodies;
    parallel_for(static_cast<int>(own.size()), [&](int number) { for_each_dof_of(model_, own[number], move_rigid); });
    return;
  }
  for_each_dof(
      model_,
      [&](std::size_t i, Lanes inverse_mass) {
        trial_.position.compliant[i] = state.position.compliant[i] + dt * state.reduced_momentum.compliant[i] +
                                       half * inverse_mass * state.force.compliant[i];
      },
      move_rigid);
}

/// Moves compliant bodies with a mass matrix: x1 = x0 + C (dt y + half D^-1 f), half = dt^2/2. Batch by batch, while it
/// is in the cache.
void Verlet::move_by_momenta(const State& state, double dt, double half) {
  for_each_batch(model_, [&](int b) {
    const Batch& batch = model_.batches[b];
    thread_local std::vector<Lanes> scratch[2];  // memory is allocated once
    for (std::vector<Lanes>& one : scratch) one.resize(2 * static_cast<std::size_t>(batch.slots));
    Lanes *reduced_displacement = scratch[0].data(), *displacement = scratch[1].data();  // of the calling thread
    const auto for_each_slot = [&](auto&& visit) {
      if (batch.layout == Layout::nodewise) return parallel_for(batch.slots, visit);
      for (int slot = 0; slot < batch.slots; ++slot) visit(slot);
    };
    with_nodes(model_, batch, [&](const auto& nodes) {
      for_each_slot([&](int slot) {
        const Lanes inverse_mass = nodes.inverse_mass_at_unit_density[slot] * batch.inverse_density;
        for (int i = 2 * slot; i < 2 * slot + 2; ++i) {
          const std::size_t at = batch.offset + static_cast<std::size_t>(i);
          reduced_displacement[i] =
              dt * state.reduced_momentum.compliant[at] + half * inverse_mass * state.force.compliant[at];
        }
      });
    });
    apply_reciprocal_mass(model_, batch, reduced_displacement, displacement);
    for_each_slot([&](int slot) {
      for (int i = 2 * slot; i < 2 * slot + 2; ++i) {
        const std::size_t at = batch.offset + static_cast<std::size_t>(i);
        trial_.position.compliant[at] = state.position.compliant[at] + displacement[i];
      }
    });
  });
}

/// Predicts the mean velocity of the step and the velocity at its end for constant accelerations, apart from mass
/// damping.
void Verlet::predict_velocities(const State& state, double dt) {
  parallel_for(static_cast<int>(model_.own.regions.size()), [&](int number) {
    const Region& region = model_.regions[model_.own.regions[number]];
    const Batch& batch = model_.batches[region.batch];
    const DampedStep<Lanes> damped = damped_step(dt * batch.mass_damping);
    with_nodes(model_, batch, [&](const auto& nodes) {
      for (int i = 2 * region.first; i < 2 * region.last; ++i) {
        const std::size_t at = batch.offset + static_cast<std::size_t>(i);
        const Lanes change =
            dt * (nodes.inverse_mass_at_unit_density[i / 2] * batch.inverse_density) * state.force.compliant[at];
        mean_velocity_.compliant[at] = state.reduced_momentum.compliant[at] + damped.mean * change;
        end_velocity_.compliant[at] = state.reduced_momentum.compliant[at] + damped.end * change;
      }
    });
  });
  for_each_rigid_dof(model_, [&](std::size_t i, const RigidDof& dof) {
    const double x = state.position.rigid[i], v = state.reduced_momentum.rigid[i];
    const DampedStep<double> damped = damped_step(dt * damping_rate(dof, {state.time}));
    const double change = dt * dof.inverse_mass * state.force.rigid[i];
    mean_velocity_.rigid[i] =
        dof.imposed(state.time) ? (dof.position_after(state.time, dt, x, x) - x) / dt : v + damped.mean * change;
    end_velocity_.rigid[i] = dof.velocity_after(state.time, state.time + dt, v + damped.end * change);
  });
  if (!model_.has_reciprocal_mass) return;
  material_velocity(model_, end_velocity_, moving_velocity_);
  std::swap(end_velocity_, moving_velocity_);
}

void Verlet::move_by_mean_velocity(const State& state, double dt) {
  const std::vector<Lanes>& velocity = material_velocity(model_, mean_velocity_, moving_velocity_).compliant;
  for_each_dof(
      model_,
      [&](std::size_t i, Lanes) { trial_.position.compliant[i] = state.position.compliant[i] + dt * velocity[i]; },
      [&](std::size_t i, const RigidDof& dof) {
        const double x = state.position.rigid[i];
        trial_.position.rigid[i] = dof.position_after(state.time, dt, x, x + dt * mean_velocity_.rigid[i]);
      });
}

/// Computes velocities at the end of the step, and the largest |a_new - a_old| / d. It does so before the step is
/// accepted, while forces are in the cache. Damping is added at the end: the errors of the step are those of all other
/// forces, which the step takes as constant.
void Verlet::update_region(const State& state, double dt, int r) {
  const Region& region = model_.regions[r];
  const Batch& batch = model_.batches[region.batch];
  const Lanes* old_force = &state.force.compliant[batch.offset];
  const Lanes* old_velocity = &state.reduced_momentum.compliant[batch.offset];
  const Lanes* mean = batch.mass_damped ? &mean_velocity_.compliant[batch.offset] : nullptr;
  Lanes *velocity = &trial_.reduced_momentum.compliant[batch.offset], *force = &trial_.force.compliant[batch.offset];
  const Lanes z = dt * batch.mass_damping, rate = batch.mass_damping * batch.density;
  const Lanes upper_inverse_density = with_tables(
      model_, batch, [&](const auto& tables) { return tables.reciprocal_mass_bound * batch.inverse_density; });
  with_nodes(model_, batch, [&](const auto& nodes) {
    Lanes worst{}, any_nan{};  // squared
    for (int slot = region.first; slot < region.last; ++slot) {
      const auto inverse_mass_at_unit_density = nodes.inverse_mass_at_unit_density[slot];
      Lanes square{};
      for (int i = 2 * slot; i < 2 * slot + 2; ++i) {
        velocity[i] = old_velocity[i] +
                      0.5 * dt * (inverse_mass_at_unit_density * batch.inverse_density) * (old_force[i] + force[i]);
        Lanes change = force[i] - old_force[i];
        if (batch.mass_damped) {
          const Lanes coefficient = rate * nodes.mass_at_unit_density[slot];
          velocity[i] += z * (0.5 * old_velocity[i] - mean[i]);
          change -= coefficient * old_velocity[i];
          force[i] -= coefficient * velocity[i];
        }
        square += change * change;
      }
      const auto scale = inverse_mass_at_unit_density / nodes.nodal_distance[slot];
      const Lanes error = scale * scale * square;
      worst = max(worst, error);
      any_nan += error;
    }
    const double result = largest(sqrt(worst) * upper_inverse_density);
    change_[r] = std::isfinite(sum(any_nan)) ? result : std::numeric_limits<double>::infinity();
  });
}

/// As update_region; the change is that of the outline nodes, over their spacing.
void Verlet::update_rigid(const State& state, double dt, int r) {
  const RigidBody& body = model_.rigid_bodies[r];
  const auto finish_dof = [&](std::size_t c) {  // returns |a_new - a_old|
    const RigidDof& dof = body.dof[c];
    const std::size_t i = 3 * static_cast<std::size_t>(r) + c;
    const double coefficient = damping_coefficient(dof, {state.time}), before = state.reduced_momentum.rigid[i];
    double& force = trial_.force.rigid[i];
    const double change = std::abs(force - (state.force.rigid[i] + coefficient * before));
    double free = before + 0.5 * dt * dof.inverse_mass * (state.force.rigid[i] + force);
    if (coefficient > 0) free += dt * coefficient * dof.inverse_mass * (0.5 * before - mean_velocity_.rigid[i]);
    trial_.reduced_momentum.rigid[i] = dof.velocity_after(state.time, trial_.time, free);
    force -= coefficient * trial_.reduced_momentum.rigid[i];
    return change * dof.inverse_mass_at(state.time);
  };
  const double x = finish_dof(0), y = finish_dof(1), angle = finish_dof(2);
  const double worst = std::sqrt(x * x + y * y) + body.max_radius * angle;
  change_[model_.regions.size() + static_cast<std::size_t>(r)] = std::isfinite(x + y + angle)
                                                                     ? worst / model_.outlines[body.outline].spacing
                                                                     : std::numeric_limits<double>::infinity();
}

/// Largest dt^2 |a_new - a_old| / (6 d) of all nodes, independent of the direction of the axes.
double Verlet::error(double dt) const { return dt * dt / 6 * largest(change_, 0); }

void Verlet::add_damping_work(const State& state, StepReport& report) {
  report.damping_work = 0.5 * report.dt * (state.damping_power + report.evaluation.damping_power);
  if (has_mass_damping_)
    report.damping_work += damping_loss_.work({state.time}, report.dt, state.reduced_momentum, mean_velocity_);
}

/// After acceptance the trial holds the state before the step.
void Verlet::accepted(State& state, const StepReport& report) {
  if (body_correction_.is_active())
    body_correction_.add_work(trial_, state), body_correction_.correct(trial_, state, report.dt);
  if (model_.scene.cell && model_.scene.cell->is_stress_controlled()) check_cell_holds(state);
  if (state.steps % bound_period == 0)
    forces_.phases().apart(Phase::bound, [&] { bound_.update_internal(state.position, state.memory); });
}

}  // namespace pliant
