#include "reference/time_stepping.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "reference/cell_motion.hpp"
#include "reference/relaxation.hpp"
#include "reference/selection.hpp"

namespace pliant::reference {
namespace {

constexpr int most_bisections = 10;  ///< of a step, down to a thousandth of it
// Limits of pseudo-transient continuation, over a segment:
constexpr double longest_pseudo_step = 0.2;  ///< so that contacts are not missed
constexpr double furthest = 10;              ///< bodies that move further do not come to rest
constexpr double lost_penetration = 1;       ///< over a segment's length; deeper ones look like the far side

std::string trouble_of(const Forces& forces, const Bodies& bodies) {
  if (!(forces.least_jacobian > 0))
    return fmt::format("J = {:.3g} in '{}'", forces.least_jacobian,
                       bodies.all()[static_cast<std::size_t>(forces.worst_body)].placed.name);
  if (forces.deepest > lost_penetration)
    return fmt::format("a penetration of {:.2g} of a segment, allowed: {}", forces.deepest, lost_penetration);
  return {};
}

/// Times at which loads jump or bonds are made: ascending, s.
std::vector<double> switch_times(const System& system) {
  std::vector<double> times = system.loads().switch_times();
  for (const double time : system.bonds().times()) times.push_back(time);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// Body with the largest residual of a degree of freedom, [dofs]. Reactions of imposed ones do not count.
std::string worst_body(const Vector& residual, const Bodies& bodies) {
  Eigen::Index worst = 0;
  if (residual.size() > 0) residual.cwiseAbs().maxCoeff(&worst);
  for (const Body& body : bodies.all())
    if (worst < body.first_dof + body.dofs) return body.placed.name;
  return {};
}

}  // namespace

double EnergyBalance::made() const { return mechanical() - at_start - external_work() + dissipated(); }

double EnergyBalance::scale() const { return std::max({std::abs(external_work()), std::abs(at_start), dissipated()}); }

double EnergyBalance::balance_error() const { return scale() > 0 ? std::abs(made()) / scale() : 0.0; }

struct TimeStepping::Trial {
  Motion motion;
  Vector acceleration;
  Forces forces;
};

TimeStepping::TimeStepping(System& system, const SolverOptions& options)
    : system_(system),
      options_(options),
      beta_(0.25 * (1 - options.hht) * (1 - options.hht)),
      gamma_(0.5 - options.hht),
      mass_(system.bodies().mass(options.mass)),
      switch_times_(switch_times(system)),
      held_(held_in_cell(system.bodies())) {
  const Bodies& bodies = system.bodies();
  motion_ = {bodies.initial_positions(), bodies.initial_velocities(), 0};
  motion_.moves = !options.statics;
  if (options.statics)
    motion_.v.setZero();
  else
    turn_cell();
  for (int i = 0; i < bodies.dofs(); ++i)
    if (!options.statics && system.loads().imposed(i, 0)) motion_.v[i] = system.loads().imposed_velocity(i, 0);
  acceleration_ = Vector::Zero(bodies.dofs());
  forces_ = evaluate(motion_, true);
  if (const std::string trouble = trouble_of(forces_, bodies); !trouble.empty())
    throw PhysicsError(fmt::format("at the start: {}", trouble));
  system.accept();
  if (options.statics) {
    const Vector mass = bodies.lumped_mass();
    holding_ = forces_.stiffness.diagonal().cwiseAbs().maxCoeff() / mass.maxCoeff() * mass;
    arms_ = bodies.arms();
  } else {
    find_acceleration();
  }
  balance_.kinetic = 0.5 * motion_.v.dot(mass_ * motion_.v);
  balance_.strain = forces_.strain, balance_.contact = forces_.contact, balance_.boundary = forces_.boundary;
  balance_.at_start = balance_.mechanical();
}

std::vector<int> TimeStepping::free_dofs(double time) const {
  std::vector<int> free;
  for (int i = 0; i < system_.bodies().dofs(); ++i) {
    const bool held = options_.statics && std::ranges::find(held_, i) != held_.end();
    if (!held && !system_.loads().imposed(i, time)) free.push_back(i);
  }
  return free;
}

void TimeStepping::find_acceleration() {
  const std::vector<int> free = free_dofs(motion_.time);
  const SparseMatrix select = selection(free, system_.bodies().dofs());
  LinearSolver solver;
  acceleration_ =
      select * solver.solve(restricted(mass_, select), -Vector(select.transpose() * forces_.residual), true);
}

StepRecord TimeStepping::step(double until) {
  StepRecord record;
  record.dt = until - motion_.time;
  const auto next = std::upper_bound(switch_times_.begin(), switch_times_.end(), motion_.time),
             last = std::lower_bound(next, switch_times_.end(), until);
  for (const double time : std::vector<double>(next, last)) step(time, 0, record);
  step(until, 0, record);
  return record;
}

void TimeStepping::step(double until, int depth, StepRecord& record) {
  Trial trial;
  if (try_step(until, trial, record)) return accept(trial);
  if (depth == most_bisections)
    throw PhysicsError(fmt::format(
        "t = {:.6g} s: no solution for a step of {:.3g} s, a thousandth of the one asked for: {}; last good state: t = "
        "{:.6g} s, least J there {:.3g}",
        until, until - motion_.time, record.trouble, motion_.time, forces_.least_jacobian));
  ++record.bisections;
  step(0.5 * (motion_.time + until), depth + 1, record);
  step(until, depth + 1, record);
}

/// Evaluates forces with mass-proportional damping.
Forces TimeStepping::evaluate(const Motion& motion, bool tangent) {
  Forces forces = system_.evaluate(motion, tangent);
  const Vector& rate = system_.loads().mass_damping();
  if (!motion.moves || rate.isZero(0)) return forces;
  const Vector damping = mass_ * rate.cwiseProduct(motion.v);
  forces.damping += damping, forces.residual += damping, forces.magnitude += damping.cwiseAbs();
  if (tangent) forces.viscosity += mass_ * rate.asDiagonal();
  return forces;
}

/// Positions after dt without the acceleration at its end. The unknowns are relative to these: in a short step a
/// difference of positions would lose the acceleration to rounding. Statics: relative to the origin.
Vector TimeStepping::predicted(double dt) const {
  if (options_.statics) return Vector::Zero(motion_.q.size());
  return motion_.q + dt * motion_.v + dt * dt * (0.5 - beta_) * acceleration_;
}

Motion TimeStepping::motion_at(double until, const Vector& ahead) const {
  const double dt = until - motion_.time;
  if (options_.statics) return {ahead, Vector::Zero(ahead.size()), until, false};
  Vector v = motion_.v + dt * ((1 - gamma_) * acceleration_ + gamma_ * acceleration_at(dt, ahead));
  for (int i = 0; i < v.size(); ++i)
    if (system_.loads().imposed(i, motion_.time)) v[i] = system_.loads().imposed_velocity(i, until);
  return {predicted(dt) + ahead, std::move(v), until, true, true};
}

/// `ahead`: displacement from the predicted positions. `trial`: motion and forces there.
Linearisation TimeStepping::equations(double until, const SparseMatrix& select, const Vector& ahead, bool tangent,
                                      Trial& trial) {
  const double dt = until - motion_.time;
  trial.motion = motion_at(until, ahead);
  trial.forces = evaluate(trial.motion, tangent);
  const Forces& forces = trial.forces;
  Linearisation result;
  result.trouble = trouble_of(forces, system_.bodies());
  result.admissible = result.trouble.empty();
  if (!result.admissible) return result;
  const SparseMatrix pick = select.transpose();
  Vector residual = forces.residual, magnitude = forces.magnitude;
  SparseMatrix matrix = forces.stiffness;
  if (!options_.statics) {
    const Vector inertia = mass_ * acceleration_at(dt, ahead);
    residual = inertia + (1 + options_.hht) * residual - options_.hht * forces_.residual;
    magnitude += inertia.cwiseAbs();
    if (tangent) result.sensitivity = pick * Vector(motion_.q.lpNorm<Eigen::Infinity>() * matrix.diagonal().cwiseAbs());
    if (tangent)
      matrix = mass_ / (beta_ * dt * dt) + (1 + options_.hht) * (matrix + gamma_ / (beta_ * dt) * forces.viscosity);
  }
  result.residual = pick * residual;
  result.magnitude = pick * magnitude;
  result.symmetric = forces.symmetric;
  result.potential = forces.potential;
  if (tangent) result.matrix = restricted(matrix, select);
  worst_ = worst_body(select * result.residual, system_.bodies());
  return result;
}

bool TimeStepping::try_step(double until, Trial& trial, StepRecord& record) {
  const double dt = until - motion_.time;
  // The search starts at the present positions, which follow the cell.
  const CellMotion cell(system_.bodies().scene(), motion_.time, until);
  Vector q = cell.carried(system_.bodies(), motion_.q);
  Vector ahead =
      options_.statics ? q : Vector(-dt * motion_.v - dt * dt * (0.5 - beta_) * acceleration_ + (q - motion_.q));
  const Vector origin = predicted(dt);
  for (int i = 0; i < q.size(); ++i)
    if (system_.loads().imposed(i, motion_.time)) {
      q[i] = system_.loads().imposed_position(i, q[i], motion_.time, until);
      ahead[i] = q[i] - origin[i];
    }
  const SparseMatrix select = selection(free_dofs(motion_.time), system_.bodies().dofs());
  record.dt = std::min(record.dt, dt);
  if (moves_too_far(q, cell, record)) return false;
  Vector free = select.transpose() * ahead;
  const Vector start = free, imposed = ahead - select * free;
  const Equations system = [&](const Vector& x, bool tangent) {
    return equations(until, select, imposed + select * x, tangent, trial);
  };
  NewtonResult result = solve_newton(system, options_.newton, solver_, free);
  bool found = note(result, record) && !moves_too_far(trial.motion.q, cell, record);
  if (options_.statics && options_.pseudo_inertia > 0 && !(found && result.stable)) {
    free = start;
    const RelaxationOptions settling{.tolerance = options_.newton.tolerance,
                                     .start = options_.pseudo_inertia,
                                     .longest = longest_pseudo_step * system_.bodies().finest_spacing(),
                                     .furthest = furthest * system_.bodies().finest_spacing()};
    const SparseMatrix pick = select.transpose();
    found = note(relax(system, pick * holding_, pick * arms_, settling, solver_, free), record);
    if (found) system(free, false);  // the last trial may not be the accepted one
  }
  if (!found) return false;
  trial.acceleration = options_.statics ? Vector::Zero(q.size()) : acceleration_at(dt, imposed + select * free);
  return true;
}

/// Records the result of a solution; returns whether it converged.
bool TimeStepping::note(const NewtonResult& result, StepRecord& record) const {
  record.iterations += result.iterations;
  if (!result.residuals.empty()) record.residual = result.residuals.back(), record.residuals = result.residuals;
  if (!result.converged) record.trouble = fmt::format("{} (largest residual in '{}')", result.trouble, worst_);
  return result.converged;
}

bool TimeStepping::moves_too_far(const Vector& q, const CellMotion& cell, StepRecord& record) const {
  const double moved = largest_motion(q, cell);
  if (moved <= system_.bodies().finest_spacing()) return false;
  record.trouble = fmt::format("outlines move by {:.3g} m, more than a segment: contacts could be missed", moved);
  return true;
}

/// Largest displacement of the outlines from the present motion, relative to each other in a cell that is deformed; 0
/// if there is nothing to touch.
double TimeStepping::largest_motion(const Vector& next, const CellMotion& cell) const {
  const Bodies& bodies = system_.bodies();
  if (bodies.all().size() < 2 || bodies.scene().contacts.empty()) return 0;
  const Points before = bodies.outline_positions(cell.carried(bodies, motion_.q)),
               after = bodies.outline_positions(next);
  double largest = 0;
  for (std::size_t k = 0; k < before.size(); ++k) largest = std::max(largest, (after[k] - before[k]).norm());
  return largest + cell.parting(bodies);
}

void TimeStepping::update_balance(const Trial& trial) {
  const Loads& loads = system_.loads();
  const Motion &before = motion_, &after = trial.motion;
  const Vector moved = after.q - before.q;
  const Bodies& bodies = system_.bodies();
  balance_.work_of_gravity += 0.5 * (loads.gravity(before.time) + loads.gravity(after.time)).dot(moved);
  balance_.work_of_loads += 0.5 * (loads.applied({before.time}) + loads.applied(after.instant())).dot(moved) +
                            loads.outline_work(bodies.outline_positions(before.q), before.time,
                                               bodies.outline_positions(after.q), after.instant());
  // A dashpot between a node and a moving target dissipates the work of both.
  if (after.moves) {
    const double by_targets =
        loads.dashpot_work(forces_.outline_velocity, before.time, trial.forces.outline_velocity, after.instant());
    balance_.work_of_loads += by_targets;
    balance_.dissipated_by_damping += by_targets;
  }
  // The constraint of an imposed motion supplies its kinetic energy and works against the other forces.
  for (int i = 0; i < moved.size(); ++i)
    if (loads.imposed(i, before.time))
      balance_.work_of_loads += 0.5 * mass_.coeff(i, i) * (after.v[i] * after.v[i] - before.v[i] * before.v[i]) +
                                0.5 * (forces_.residual[i] + trial.forces.residual[i]) * moved[i];
  balance_.work_of_loads += work_on_images(trial);
  balance_.dissipated_by_contact += trial.forces.dissipated;
  balance_.dissipated_by_plasticity += trial.forces.plastic_loss;
  balance_.dissipated_by_bonds += trial.forces.bond_loss;
  balance_.dissipated_by_damping += 0.5 * (forces_.damping + trial.forces.damping).dot(moved);
  if (after.moves)
    balance_.dissipated_by_damping +=
        0.5 * (after.time - before.time) * (forces_.creep_power + trial.forces.creep_power);
  balance_.kinetic = 0.5 * after.v.dot(mass_ * after.v);
  balance_.strain = trial.forces.strain, balance_.contact = trial.forces.contact,
  balance_.boundary = trial.forces.boundary;
}

/// Work of the cell on the images of bodies, by the mean of the forces, J/m.
double TimeStepping::work_on_images(const Trial& trial) const {
  const CellMotion cell(system_.bodies().scene(), motion_.time, trial.motion.time);
  return 0.5 * (forces_.on_periods + trial.forces.on_periods).cwiseProduct(cell.change()).sum();
}

void TimeStepping::accept(const Trial& trial) {
  update_balance(trial);
  system_.accept();
  system_.make_bonds(trial.motion);
  motion_ = trial.motion;
  acceleration_ = trial.acceleration;
  forces_ = trial.forces;
  if (std::binary_search(switch_times_.begin(), switch_times_.end(), motion_.time)) pass_switch();
}

/// Gives a cell the rate of its histories from now on, and all matter the jump of its velocity gradient.
void TimeStepping::turn_cell() {
  const Bodies& bodies = system_.bodies();
  const Eigen::Matrix2d rate = gradient_rate(bodies.scene(), motion_.time), jump = rate - cell_rate_;
  if (jump.isZero(0)) return;
  motion_.v += velocities_of_flow(bodies, motion_.q, velocity_gradient(bodies.scene(), motion_.time, jump));
  cell_rate_ = rate;
}

/// Loads jump at ends of windows: the next step starts from the values after that. Springs that begin or end to act add
/// or remove their energy.
void TimeStepping::pass_switch() {
  if (options_.statics) return;
  motion_.ends_step = false;
  if (system_.bodies().scene().cell) {
    turn_cell();
    const double kinetic = 0.5 * motion_.v.dot(mass_ * motion_.v);
    balance_.work_of_loads += kinetic - balance_.kinetic;
    balance_.kinetic = kinetic;
  }
  const double stored = forces_.boundary;
  forces_ = evaluate(motion_, false);
  find_acceleration();
  balance_.work_of_loads += forces_.boundary - stored;
  balance_.boundary = forces_.boundary;
}

}  // namespace pliant::reference
