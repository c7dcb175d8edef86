#include "dynamics/step_doubling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodies/damping_forces.hpp"
#include "bodies/for_each_dof.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "boundary/loads.hpp"
#include "dynamics/mass_damping.hpp"

namespace pliant {
namespace {

/// Bounds of the controller's factor on dt, as the error may vanish or explode.
constexpr double least_change = 0.2, largest_change = 2;
constexpr double first_share = 1e-3;  ///< of the time of a wave between nodes

/// Least nodal distance over wave speed: scale for the first step and the smallest step, not a limit.
double wave_time(const Model& model) {
  double result = model.scene.time.end;
  for (const Body& body : model.bodies) {
    if (body.kind != BodyKind::compliant) continue;
    const std::vector<double>& distance = model.shape_of(body).space.nodal_distance;
    const double least = body.scale * *std::min_element(distance.begin(), distance.end());
    const Batch& batch = model.batches[body.batch];
    const double modulus = batch.lambda[body.lane] + 2 * batch.mu[body.lane];
    result = std::min(result, least * std::sqrt(model.scene.materials[body.material].density / modulus));
  }
  return result;
}

struct LanePair {
  Lanes x{}, y{};
};

/// u = sum phi U at one field node of the bodies of a batch; Rows: ShapeRows or LaneRows.
template <class Rows>
LanePair displacement(const Rows& rows, const Lanes* d, int node) {
  LanePair u;
  for (int e = rows.start[node]; e < rows.start[node + 1]; ++e) {
    u.x += rows.value[e] * d[2 * rows.node[e]];
    u.y += rows.value[e] * d[2 * rows.node[e] + 1];
  }
  return u;
}

/// The same at the nodes of one slot of a nodewise body; 0 in padding.
LanePair displacement(const ShapeRows& rows, const NodewiseShape& shape, const double* d, int slot) {
  LanePair u;
  const int first = lane_count * slot, count = std::min(lane_count, static_cast<int>(shape.order.size()) - first);
  for (int lane = 0; lane < count; ++lane) {
    const int node = shape.order[first + lane];
    for (int e = rows.start[node]; e < rows.start[node + 1]; ++e) {
      const double* of_node = d + shape.offset[rows.node[e]];
      u.x[lane] += rows.value[e] * of_node[0];
      u.y[lane] += rows.value[e] * of_node[lane_count];
    }
  }
  return u;
}

}  // namespace

StepDoubling::StepDoubling(Forces& forces, const State&)
    : forces_(forces),
      model_(forces.model()),
      has_mass_damping_(has_mass_damping(forces.model())),
      damping_loss_(forces.model()),
      wave_time_(wave_time(model_)),
      start_force_(zero_dofs(model_)),
      trial_(model_),
      difference_(model_.compliant_size) {}

double StepDoubling::first_dt() const { return first_share * wave_time_; }

Proposal StepDoubling::propose(const State& state, double next_dt, double until) const {
  const double remaining = until - state.time;
  if (next_dt >= remaining) return {remaining, until, next_dt, wave_time_, StepLimit::until};
  return {next_dt, state.time + next_dt, next_dt, wave_time_, StepLimit::error};
}

Verdict StepDoubling::judge(const State&, const StepControl&, const Proposal& proposal,
                            const StepReport& report) const {
  const TimeSettings& settings = model_.scene.time;
  const double factor = report.error > 0 ? std::pow(report.error / settings.target, -settings.beta) : largest_change;
  const double next_dt = proposal.dt * std::clamp(factor, least_change, largest_change);
  if (!within_tolerance(report)) return {false, {next_dt}};
  return {true, {proposal.controller_dt > proposal.dt ? std::max(next_dt, proposal.controller_dt) : next_dt}};
}

void StepDoubling::attempt(State& state, const Proposal& proposal, StepReport& report) {
  Halves halves = try_halves(state, proposal, report);
  if (halves == Halves::voided) halves = try_halves(state, proposal, report);
  if (halves == Halves::voided) report.evaluation.valid = false;
  if (halves != Halves::done) report.error = std::numeric_limits<double>::infinity();
}

/// Two half steps and, if their error is acceptable, the forces at the end, from which the next step starts.
StepDoubling::Halves StepDoubling::try_halves(State& state, const Proposal& proposal, StepReport& report) {
  const double half = 0.5 * proposal.dt, middle = state.time + half;
  const Instant first{middle + 0.5 * half}, second{proposal.end_time, true};
  find_start_force(state, half);
  half_step(state.position, state.reduced_momentum, start_force_, state.time, half);
  const bool is_covered = show(state, first, proposal, report).valid;
  evaluate(first, {state.memory, half, &state.outlines.position}, half_memory_, report);
  report.evaluation.valid &= is_covered;
  if (!report.evaluation.valid) return Halves::failed;
  const double slip_work = report.evaluation.contact.dissipated, damping_power = report.evaluation.damping_power,
               material_loss = report.evaluation.material_loss, bond_loss = report.evaluation.bonds.loss;
  half_outlines_ = trial_.outlines.position;
  half_step(trial_.position, trial_.reduced_momentum, trial_.force, middle, half);
  report.error = error(state, proposal.dt);
  if (!within_tolerance(report)) return Halves::done;
  if (show(state, second, proposal, report).rebuilt) return Halves::voided;
  if (!evaluate(second, {half_memory_, half, &half_outlines_}, trial_.memory, report)) return Halves::failed;
  report.evaluation.contact.dissipated += slip_work;
  report.evaluation.material_loss += material_loss;
  report.evaluation.bonds.loss += bond_loss;
  report.damping_work = half * (damping_power + report.evaluation.damping_power);
  return Halves::done;
}

/// Forces at the start with the mean of the loads over the half step. Loads are linear in time within a step, as steps
/// end at the points of histories.
void StepDoubling::find_start_force(const State& state, double half) {
  start_force_ = state.force;
  if (model_.switch_times.empty() || state.time >= model_.switch_times.back()) return;
  const Dofs& velocity = material_velocity(model_, state.reduced_momentum, moving_velocity_);
  add_load_change(model_, {state.position, velocity, state.time}, state.outlines, {state.time + 0.5 * half},
                  start_force_);
}

Motion StepDoubling::motion(const Instant& at) const {
  return {trial_.position, model_.has_reciprocal_mass ? moving_velocity_ : trial_.reduced_momentum, at.time,
          at.ends_step};
}

/// Updates the trial's outlines, and makes candidates valid for them. `at`: the time of the loads. Laws that change at
/// the end of a step do so in the next one, because both halves of a step need the same laws.
Forces::ListCheck StepDoubling::show(State& state, const Instant& at, const Proposal& proposal, StepReport& report) {
  trial_.time = at.time;
  ++report.evaluations;
  forces_.phases().enter(Phase::outlines);
  update_outlines(model_, motion(at), trial_.outlines);
  if (proposal.is_output_sample) return {};
  const double time = at.ends_step ? std::nextafter(at.time, state.time) : at.time;
  return forces_.ensure_candidates(state, trial_.outlines.position, time);
}

/// Evaluates forces; returns whether they are valid.
bool StepDoubling::evaluate(const Instant& at, const PreviousHistory& from, Memory& to, StepReport& report) {
  report.evaluation = forces_.evaluate(motion(at), trial_.outlines, from, {trial_.force, trial_.contact_force, to});
  if (!has_mass_damping_) return report.evaluation.valid;
  add_mass_damping(model_, at, trial_.reduced_momentum, trial_.force);
  report.evaluation.damping_power += damping_loss_.power(at, trial_.reduced_momentum);
  return report.evaluation.valid;
}

/// Writes v + half a, and u + half times that v, from `time` on, to the trial; the arguments may be the trial's own.
void StepDoubling::half_step(const Dofs& position, const Dofs& velocity, const Dofs& force, double time, double half) {
  const bool has_reciprocal_mass = model_.has_reciprocal_mass;
  for_each_dof(
      model_,
      [&](std::size_t i, Lanes inverse_mass) {
        trial_.reduced_momentum.compliant[i] = velocity.compliant[i] + half * inverse_mass * force.compliant[i];
        if (!has_reciprocal_mass)
          trial_.position.compliant[i] = position.compliant[i] + half * trial_.reduced_momentum.compliant[i];
      },
      [&](std::size_t i, const RigidDof& dof) {
        const double x = position.rigid[i], v = velocity.rigid[i] + half * dof.inverse_mass * force.rigid[i];
        trial_.reduced_momentum.rigid[i] = dof.velocity_after(time, time + half, v);
        trial_.position.rigid[i] = dof.position_after(time, half, x, x + half * v);
      });
  if (!has_reciprocal_mass) return;
  material_velocity(model_, trial_.reduced_momentum, moving_velocity_);
  for (std::size_t i = 0; i < position.compliant.size(); ++i)
    trial_.position.compliant[i] = position.compliant[i] + half * moving_velocity_.compliant[i];
}

/// u2 - u1 = dt^2/4 a_half - dt^2/2 a at the degrees of freedom.
void StepDoubling::find_difference(const Region& region, double dt) {
  const Batch& batch = model_.batches[region.batch];
  Lanes* d = &difference_[batch.offset];
  const Lanes *start = &start_force_.compliant[batch.offset], *middle = &trial_.force.compliant[batch.offset];
  with_nodes(model_, batch, [&](const auto& nodes) {
    for (int i = 2 * region.first; i < 2 * region.last; ++i)
      d[i] = 0.25 * dt * dt * nodes.inverse_mass_at_unit_density[i / 2] * batch.inverse_density *
             (middle[i] - 2.0 * start[i]);
  });
}

void StepDoubling::apply_reciprocal_mass_to_difference() {
  reduced_difference_ = difference_;
  for_each_batch(model_, [&](int b) {
    const Batch& batch = model_.batches[b];
    apply_reciprocal_mass(model_, batch, &reduced_difference_[batch.offset], &difference_[batch.offset]);
  });
}

double StepDoubling::region_error(const Region& region) const {
  const Batch& batch = model_.batches[region.batch];
  const Lanes* d = &difference_[batch.offset];
  const auto largest_of = [&](const auto& displacement_at) {
    return with_nodes(model_, batch, [&](const auto& nodes) {
      Lanes worst{}, any_nan{};
      for (int slot = region.first; slot < region.last; ++slot) {
        const LanePair u = displacement_at(slot);
        worst = max(worst, sqrt(u.x * u.x + u.y * u.y) * (1 / nodes.nodal_distance[slot]));
        any_nan += u.x + u.y;
      }
      return std::isfinite(sum(any_nan)) ? largest(worst) : std::numeric_limits<double>::infinity();
    });
  };
  if (batch.layout != Layout::nodewise)
    return with_tables(model_, batch, [&](const auto& tables) {
      return largest_of([&](int node) { return displacement(tables.node_rows, d, node); });
    });
  const ShapeRows& rows = model_.shape_of(batch).space.node_rows;
  const NodewiseShape& shape = model_.nodewise_shape_of(batch);
  return largest_of([&](int slot) { return displacement(rows, shape, reinterpret_cast<const double*>(d), slot); });
}

/// Largest difference of the outline nodes between the two ends u1 and u2.
double StepDoubling::rigid_error(std::size_t r, const State& state, double dt) const {
  const RigidBody& body = model_.rigid_bodies[r];
  double change[3], end[3];
  for (std::size_t c = 0; c < 3; ++c) {
    const RigidDof& dof = body.dof[c];
    const double inverse_mass = dof.inverse_mass_at(state.time);
    const double a = inverse_mass * start_force_.rigid[3 * r + c],
                 a_half = inverse_mass * trial_.force.rigid[3 * r + c];
    change[c] = 0.25 * dt * dt * (a_half - 2 * a);
    end[c] = trial_.position.rigid[3 * r + c];
  }
  const double c2 = std::cos(end[2]), s2 = std::sin(end[2]), c1 = std::cos(end[2] - change[2]),
               s1 = std::sin(end[2] - change[2]);
  double worst = 0;
  for (const Vec2& p : model_.outlines[body.outline].points) {
    const double dx = change[0] + (c2 - c1) * p.x() - (s2 - s1) * p.y(),
                 dy = change[1] + (s2 - s1) * p.x() + (c2 - c1) * p.y();
    worst = std::max(worst, dx * dx + dy * dy);
  }
  if (!std::isfinite(change[0] + change[1] + change[2])) return std::numeric_limits<double>::infinity();
  return std::sqrt(worst) / model_.outlines[body.outline].spacing;
}

double StepDoubling::error(const State& state, double dt) {
  // A nodewise body's region needs the differences of its neighbours: all are computed first.
  parallel_for(static_cast<int>(model_.regions.size()), [&](int r) { find_difference(model_.regions[r], dt); });
  if (model_.has_reciprocal_mass) apply_reciprocal_mass_to_difference();
  const double compliant =
      parallel_max(static_cast<int>(model_.regions.size()), 0, [&](int r) { return region_error(model_.regions[r]); });
  return parallel_max(static_cast<int>(model_.rigid_bodies.size()), compliant,
                      [&](int r) { return rigid_error(static_cast<std::size_t>(r), state, dt); });
}

}  // namespace pliant
