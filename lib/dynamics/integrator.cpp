#include "dynamics/integrator.hpp"

#include <algorithm>
#include <utility>

#include "bodies/damping_forces.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "boundary/loads.hpp"
#include "boundary/outline_loads.hpp"
#include "contact/halo.hpp"
#include "dynamics/cell_motion.hpp"

namespace pliant {

namespace {

/// Stores the sums of the evaluation that gave a state its forces.
void take_over_sums(const Evaluation& found, State& state) {
  state.damping_power = found.damping_power;
  state.contact_energy = found.contact.stored + found.bonds.stored;
  state.contacts = found.contact.contacts;
}

/// Applies changes of histories and windows at the end time of a step: of the forces from then on, and of the energy of
/// springs that begin or end to act.
void pass_switch(const Model& model, State& state) {
  turn_cell(model, state);
  const Instant before{state.time, true}, after{state.time};
  state.external_work +=
      support_energy(model, state.outlines.position, after) - support_energy(model, state.outlines.position, before);
  Dofs scratch;
  const Dofs& velocity = material_velocity(model, state.reduced_momentum, scratch);
  state.damping_power +=
      add_load_change(model, {state.position, velocity, state.time, true}, state.outlines, after, state.force);
}

}  // namespace

Trial::Trial(const Model& model)
    : position(zero_dofs(model)),
      reduced_momentum(position),
      force(position),
      contact_force(model.outline_offset.back()) {
  position.lattice = initial_lattice(model.scene);
}

Evaluation evaluate_at(Forces& forces, State& state, Trial& trial) {
  Dofs scratch;
  const Dofs& velocity = material_velocity(forces.model(), state.reduced_momentum, scratch);
  const Motion motion{state.position, velocity, state.time};
  update_outlines(forces.model(), motion, state.outlines);
  if (Halo* halo = forces.model().halo) {
    const HaloFields now{state.position, state.force, state.outlines};
    halo->exchange(now, now);
  }
  forces.ensure_candidates(state, state.outlines.position, state.time);
  return forces.evaluate(motion, state.outlines, {state.memory}, {trial.force, trial.contact_force, trial.memory});
}

Evaluation find_forces(Forces& forces, State& state) {
  Trial trial(forces.model());
  const Evaluation found = evaluate_at(forces, state, trial);
  std::swap(state.force, trial.force);
  std::swap(state.contact_force, trial.contact_force);
  std::swap(state.memory, trial.memory);
  add_mass_damping(forces.model(), {state.time}, state.reduced_momentum, state.force);
  take_over_sums(found, state);
  return found;
}

void swap_motion(State& state, Trial& trial) {
  std::swap(state.position, trial.position);
  std::swap(state.reduced_momentum, trial.reduced_momentum);
  std::swap(state.force, trial.force);
  std::swap(state.memory, trial.memory);
  std::swap(state.outlines, trial.outlines);
  std::swap(state.contact_force, trial.contact_force);
}

void take_over(const Model& model, State& state, Trial& trial, const StepReport& report) {
  const double end_time = trial.time;
  // Only velocities of rigid bodies count here, and their reduced momenta equal them.
  const Motion before{state.position, state.reduced_momentum, state.time},
      after{trial.position, trial.reduced_momentum, end_time, true};
  state.external_work += external_work(model, before, state.force, after, trial.force) +
                         outline_work(model, state.outlines, before.instant(), trial.outlines, after.instant());
  if (model.scene.cell) state.external_work += work_on_images(state, trial);
  state.gravity_work += gravity_work(model, before, after);
  state.dissipated += report.evaluation.contact.dissipated + report.evaluation.bonds.loss + report.damping_work +
                      report.evaluation.material_loss;
  state.damped += report.damping_work;
  state.plastic_loss += report.evaluation.material_loss;
  state.bond_loss += report.evaluation.bonds.loss;
  swap_motion(state, trial);
  state.time = end_time;
  ++state.steps;
  state.rejections += report.rejections;
  state.evaluations += report.evaluations;
  take_over_sums(report.evaluation, state);
  if (model.scene.cell) push_cell(model, state, report.dt);
  if (std::binary_search(model.switch_times.begin(), model.switch_times.end(), end_time)) pass_switch(model, state);
}

}  // namespace pliant
