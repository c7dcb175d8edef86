#include "dynamics/forces.hpp"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "bodies/internal_forces.hpp"
#include "bodies/place_outlines.hpp"
#include "boundary/loads.hpp"
#include "boundary/outline_loads.hpp"
#include "core/parallel.hpp"
#include "dynamics/body_heat.hpp"

namespace pliant {
namespace {

/// Largest penetration over the longest segment of the master window: a run warns beyond the first and rejects a step
/// beyond the second. Detection ends a skin deeper.
constexpr double warning_depth = 0.5, rejection_depth = 1;

bool has_material_loss(const Model& model) {
  return std::ranges::any_of(model.batches, [&](const Batch& batch) {
    return with_law_type<Lanes>(model.groups[batch.group].law,
                                []<class Law>(std::type_identity<Law>) { return has_loss<Law>; });
  });
}

/// Padding lanes repeat a body, so that they need no masking here.
double least_of(Lanes jacobian) { return -largest(-jacobian); }

}  // namespace

Forces::Forces(const Model& model)
    : model_(model),
      contact_(model),
      bonds_(model, contact_.laws()),
      least_jacobian_(static_cast<std::size_t>(model.lane_batches) + model.point_chunks.size(), 1e300) {
  for (std::size_t b = static_cast<std::size_t>(model.lane_batches); b < model.batches.size(); ++b)
    stresses_.emplace_back(static_cast<std::size_t>(model.nodewise_shape_of(model.batches[b]).points()));
  if (model.rates || model.material_memory > 0) damping_power_.resize(least_jacobian_.size());
  if (has_material_loss(model)) material_loss_.resize(least_jacobian_.size());
}

Forces::ListCheck Forces::ensure_candidates(State& accepted, const OutlineField& trial, double time) {
  phases_.enter(Phase::candidates);
  const RunClock clock{time, accepted.steps};
  const bool bonded = bonds_.make(accepted.outlines.position, accepted.time, accepted.memory.bonds);
  if (contact_.candidates_hold(trial, clock)) return {bonded};
  if (!bonds_.is_empty()) bonds_.measure_turning(accepted.outlines.position, accepted.memory.bonds);
  bool hold = false;
  phases_.apart(Phase::candidates,
                [&] { hold = contact_.renew_candidates(accepted.outlines, accepted.memory.contact, clock, &trial); });
  return {true, hold};
}

Evaluation Forces::evaluate_and_update(const Motion& motion, const Outlines& outlines, const PreviousHistory& from,
                                       const Output& to, const BodyUpdates& update) {
  Evaluation result;
  phases_.enter(Phase::contact);
  if (from.outlines) {
    const StepStart step{*from.outlines, from.dt, from.rigid};
    result.contact = contact_.forces(outlines, from.memory.contact, to.memory.contact, to.contact_force, &step);
  } else {
    result.contact = contact_.forces(outlines, from.memory.contact, to.memory.contact, to.contact_force);
  }
  if (!bonds_.is_empty())
    result.bonds = bonds_.add_forces(outlines.position, from.memory.bonds, to.memory.bonds, to.contact_force);
  result.damping_power = result.contact.damping_power;
  to.force.lattice = to.contact_force.lattice;
  phases_.enter(Phase::internal);
  const OutlineField* on_outlines = &to.contact_force;
  if (has_outline_loads(model_)) {
    outline_force_ = to.contact_force;
    result.damping_power += add_outline_loads(model_, motion.instant(), outlines, outline_force_);
    on_outlines = &outline_force_;
  }
  to.memory.material.resize(model_.material_memory);
  const OwnBodies& own = model_.own;
  const auto of_batch = [&](int number) {
    const int b = own.batches[number];  // region b is all of batch b (Model::regions)
    lane_forces(b, motion, *on_outlines, from, to);
    if (update.region) update.region(b);
  };
  const auto of_rigid = [&](int number) {
    const int r = own.rigid_bodies[number];
    rigid_forces(r, motion, outlines.position, *on_outlines, to.force);
    if (update.rigid) update.rigid(r);
  };
  parallel_for(own.lane_batches, of_batch, static_cast<int>(own.rigid_bodies.size()), of_rigid);
  if (!stresses_.empty()) nodewise_forces(motion, *on_outlines, from, to, update);
  phases_.enter(Phase::update);
  for (const Lanes& power : damping_power_) result.damping_power += sum(power);
  for (const Lanes& loss : material_loss_) result.material_loss += sum(loss);
  if (!from.memory.heat.empty()) {
    to.memory.heat = from.memory.heat;
    add_heat(model_, {damping_power_, material_loss_}, contact_.contact_pairs(), contact_.totals(to.memory.contact),
             from.dt, to.memory.heat);
  }
  for (double j : least_jacobian_) result.least_jacobian = std::min(result.least_jacobian, j);
  result.contact_lost = !(result.contact.deepest <= rejection_depth);
  result.valid = result.least_jacobian > 0 && !result.contact_lost;
  return result;
}

/// Motion of a batch from the history variables `from` on, with the new ones in `to`.
BatchMotion Forces::step_of(const Batch& batch, const Motion& motion, const PreviousHistory& from, Memory& to) const {
  BatchMotion step = motion_of(batch, motion.position, from.memory);
  if (batch.viscous) step.velocity = &motion.velocity.compliant[batch.offset];
  step.elapsed = from.dt;
  if (step.memory) step.new_memory = to.material.data() + batch.memory;
  return step;
}

/// All forces on the bodies of a batch with one body per lane.
void Forces::lane_forces(int b, const Motion& motion, const OutlineField& on_outlines, const PreviousHistory& from,
                         const Output& to) {
  const Batch& batch = model_.batches[b];
  const Region& region = model_.regions[b];
  Lanes* f = &to.force.compliant[batch.offset];
  std::fill_n(f, 2 * batch.slots, Lanes{});
  add_outline_forces(model_, region, on_outlines, f);
  add_gravity(model_, region, model_.scene.gravity_at(motion.time), f);
  BatchMotion step = step_of(batch, motion, from, to.memory);
  if (b + 1 < model_.lane_batches) {
    const Batch& next = model_.batches[b + 1];
    step.next_position = &motion.position.compliant[next.offset];
    step.next_forces = &to.force.compliant[next.offset];
    step.next_count = 2 * next.slots;
  }
  const PointTotals totals = add_internal_forces(model_, batch, step, f);
  least_jacobian_[b] = least_of(totals.least_jacobian);
  if (!damping_power_.empty()) damping_power_[b] = batch.weight * totals.power;
  if (!material_loss_.empty()) material_loss_[b] = batch.weight * totals.loss;
}

void Forces::rigid_forces(int r, const Motion& motion, const OutlineField& position, const OutlineField& on_outlines,
                          Dofs& force) {
  const RigidBody& rigid = model_.rigid_bodies[r];
  outline_force_resultant(model_, rigid, position, on_outlines, &motion.position.rigid[3 * r], &force.rigid[3 * r]);
  add_rigid_loads(rigid, model_.scene.gravity_at(motion.time), motion.instant(), &force.rigid[3 * r]);
}

/// All forces on nodewise bodies: stresses come first, because a region's nodes gather from points of other regions.
void Forces::nodewise_forces(const Motion& motion, const OutlineField& on_outlines, const PreviousHistory& from,
                             const Output& to, const BodyUpdates& update) {
  const auto stresses_of = [&](int batch) { return stresses_[batch - model_.lane_batches].data(); };
  parallel_for(static_cast<int>(model_.point_chunks.size()), [&](int c) {
    const Chunk& chunk = model_.point_chunks[c];
    const Batch& batch = model_.batches[chunk.batch];
    const PointTotals totals =
        nodewise_stresses(model_, chunk, step_of(batch, motion, from, to.memory), stresses_of(chunk.batch));
    least_jacobian_[model_.lane_batches + c] = least_of(totals.least_jacobian);
    if (!damping_power_.empty()) damping_power_[model_.lane_batches + c] = totals.power * batch.weight[0];
    if (!material_loss_.empty()) material_loss_[model_.lane_batches + c] = totals.loss * batch.weight[0];
  });
  parallel_for(static_cast<int>(model_.regions.size()) - model_.lane_batches, [&](int i) {
    const int r = model_.lane_batches + i;
    const Region& region = model_.regions[r];
    Lanes* f = &to.force.compliant[model_.batches[region.batch].offset];
    std::fill(f + 2 * region.first, f + 2 * region.last, Lanes{});
    add_outline_forces(model_, region, on_outlines, f);
    add_gravity(model_, region, model_.scene.gravity_at(motion.time), f);
    add_nodewise_forces(model_, region, stresses_of(region.batch), f);
    if (update.region) update.region(r);
  });
}

void Forces::warn_of_depth(const Evaluation& evaluation, double time) {
  if (evaluation.contact.deepest <= warning_depth || warned_deep_) return;
  warned_deep_ = true;
  spdlog::warn("penetration reaches {:.2f} of a segment length at t = {:.6g} s (contacts are lost at {:.1f}); {}",
               evaluation.contact.deepest, time, rejection_depth,
               time > 0 ? "consider a higher contact stiffness" : "move bodies apart that overlap at the start");
}

}  // namespace pliant
