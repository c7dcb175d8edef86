#include "dynamics/simulation.hpp"

#include <algorithm>

#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "contact/deepest_node.hpp"
#include "core/archive.hpp"
#include "dynamics/cell_motion.hpp"
#include "dynamics/failure.hpp"
#include "dynamics/take_step.hpp"

namespace pliant {

void StartPoint::require_fit(const Model& model) const {
  const bool fits = position.compliant.size() == model.compliant_size &&
                    position.rigid.size() == 3 * model.rigid_bodies.size() &&
                    reduced_momentum.compliant.size() == position.compliant.size() &&
                    reduced_momentum.rigid.size() == position.rigid.size() && material.size() == model.material_memory;
  if (!fits) throw ArchiveError("bodies have other nodes");
}

Simulation::Simulation(const Model& model, const StartPoint* from) : model_(model), forces_(model) {
  state_.force = zero_dofs(model);
  state_.memory = initial_memory(model);
  if (from) {
    begin(*from);
  } else {
    state_.position = initial_positions(model);
    state_.reduced_momentum = initial_velocities(model, state_.position);
    refuse_deep_overlap(model, placed_outlines(model, state_.position));
  }
  start_cell(model, state_);
  const Evaluation start = find_forces(forces_, state_);
  check_start(start, state_, forces_);
  forces_.warn_of_depth(start, 0);
  if (!from && start.contact.deepest > 0) overlap_ = initial_overlap(model, forces_.contact(), state_.outlines);
  ++state_.evaluations;
  auditor_ = std::make_unique<EnergyAccountant>(model, state_);
  if (model.scene.time.integrator == Integrator::verlet)
    integrator_ = std::make_unique<Verlet>(forces_, state_);
  else
    integrator_ = std::make_unique<StepDoubling>(forces_, state_);
}

void Simulation::begin(const StartPoint& start) {
  start.require_fit(model_);
  control_ = start.control;
  state_.position = start.position, state_.reduced_momentum = start.reduced_momentum;
  if (!model_.scene.cell) state_.position.lattice = initial_lattice(model_.scene);
  state_.memory.material = start.material;
  set_imposed_velocities(model_, state_.reduced_momentum);
  forces_.inherit(start.contact, start.bonds, state_.memory);
}

StartPoint Simulation::start_point() const {
  return {control_,
          state_.position,
          state_.reduced_momentum,
          state_.memory.material,
          forces_.contact().leave(state_.memory.contact),
          forces_.bonds().leave(state_.memory.bonds)};
}

StepReport Simulation::step(double until, const Observer* observer) {
  phases().begin_step(state_.steps);
  const auto& times = model_.switch_times;
  const auto next = std::upper_bound(times.begin(), times.end(), state_.time);
  if (next != times.end()) until = std::min(until, *next);
  const StepReport report =
      std::visit([&](auto& integrator) { return take_step(*integrator, forces_, state_, control_, until, observer); },
                 integrator_);
  if (report.dt > 0) statistics_.add(report, state_.time);
  phases().end_step();
  return report;
}

double Simulation::largest_dt() const {
  return std::visit([](const auto& integrator) { return integrator->largest_dt(); }, integrator_);
}

std::string Simulation::governing() const {
  return std::visit([](const auto& integrator) { return integrator->governing(); }, integrator_);
}

}  // namespace pliant
