#include "dynamics/simulation.hpp"

#include <algorithm>
#include <limits>

#include "bodies/damping_forces.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/mass_correction.hpp"
#include "bodies/update_outlines.hpp"
#include "contact/deepest_node.hpp"
#include "dynamics/failure.hpp"

namespace pliant {

Simulation::Simulation(const Model& model) : model_(model), forces_(model) {
  state_.position = initial_positions(model);
  state_.velocity = initial_velocities(model, state_.position);
  state_.force = zero_dofs(model);
  Outlines outlines = make_outlines(model);
  update_outlines(model, state_.position, outlines);
  refuse_deep_overlap(model, outlines);
  ContactHistory trial;
  const Evaluation start = forces_.evaluate({state_.position, material_velocity(model, state_.velocity), 0},
                                            state_.history, trial, state_.force);
  check_start(start, state_, forces_);
  add_drag(model, {0}, state_.velocity, state_.force);
  state_.damping_power = start.damping_power;
  forces_.warn_of_depth(start, 0);
  if (start.contact.deepest > 0) overlap_ = initial_overlap(model, forces_.contact(), forces_.outlines());
  std::swap(state_.history, trial);
  ++state_.evaluations;
  auditor_ = std::make_unique<Auditor>(forces_, state_);
  if (model.scene.time.integrator == Integrator::verlet)
    integrator_.emplace<Verlet>(forces_, state_);
  else
    integrator_.emplace<StepDoubling>(forces_, state_);
}

StepReport Simulation::step(double until) {
  const auto& times = model_.switch_times;
  const auto next = std::upper_bound(times.begin(), times.end(), state_.time);
  if (next != times.end()) until = std::min(until, *next);
  const StepReport report = integrate(until);
  statistics_.add(report, state_.time);
  return report;
}

StepReport Simulation::integrate(double until) {
  if (Verlet* verlet = std::get_if<Verlet>(&integrator_)) return verlet->step(state_, until);
  return std::get<StepDoubling>(integrator_).step(state_, until);
}

double Simulation::largest_dt() const {
  const Verlet* verlet = std::get_if<Verlet>(&integrator_);
  return verlet ? verlet->bound().largest_dt() : std::numeric_limits<double>::infinity();
}

std::string Simulation::governing() const {
  const Verlet* verlet = std::get_if<Verlet>(&integrator_);
  return verlet ? verlet->bound().governing() : "error control";
}

}  // namespace pliant
