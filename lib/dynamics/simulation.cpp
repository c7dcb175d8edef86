#include "dynamics/simulation.hpp"

#include <algorithm>

#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "contact/deepest_node.hpp"
#include "dynamics/failure.hpp"
#include "dynamics/take_step.hpp"

namespace pliant {

Simulation::Simulation(const Model& model) : model_(model), forces_(model) {
  state_.position = initial_positions(model);
  state_.reduced_momentum = initial_velocities(model, state_.position);
  state_.force = zero_dofs(model);
  state_.memory = initial_memory(model);
  refuse_deep_overlap(model, placed_outlines(model, state_.position));
  const Evaluation start = find_forces(forces_, state_);
  check_start(start, state_, forces_);
  forces_.warn_of_depth(start, 0);
  if (start.contact.deepest > 0) overlap_ = initial_overlap(model, forces_.contact(), state_.outlines);
  ++state_.evaluations;
  auditor_ = std::make_unique<Auditor>(model, state_);
  if (model.scene.time.integrator == Integrator::verlet)
    integrator_ = std::make_unique<Verlet>(forces_, state_);
  else
    integrator_ = std::make_unique<StepDoubling>(forces_, state_);
}

StepReport Simulation::step(double until, const Observer* observer) {
  phases().begin_step(state_.steps);
  const auto& times = model_.switch_times;
  const auto next = std::upper_bound(times.begin(), times.end(), state_.time);
  if (next != times.end()) until = std::min(until, *next);
  const StepReport report = std::visit(
      [&](auto& integrator) { return take_step(*integrator, forces_, state_, until, observer); }, integrator_);
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
