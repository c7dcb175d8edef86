#include "bodies/nodal.hpp"
#include "dynamics/body_heat.hpp"
#include "results/body_motion.hpp"
#include "results/point_states.hpp"
#include "results/probes/probe_functions.hpp"

namespace pliant {
namespace {

Samples energy(const Snapshot& snapshot, const Selection&) {
  const EnergyBalance& audit = snapshot.energy_balance();
  const Energies& e = audit.energy;
  Samples samples(8);
  samples.add(1, {e.kinetic, e.strain, e.contact, e.boundary, e.dissipated, e.external_work, snapshot.balance_error(),
                  audit.momentum_error});
  return samples;
}

/// The state holds the work of walls and loads alone; the audit adds gravity's.
Samples works(const Snapshot& snapshot, const Selection&) {
  const State& state = snapshot.state();
  Samples samples(6);
  samples.add(1, {state.external_work, snapshot.energy_balance().energy.external_work - state.external_work,
                  state.dissipated - state.damped - state.plastic_loss - state.bond_loss, state.damped,
                  state.plastic_loss, state.bond_loss});
  return samples;
}

double kinetic_energy_of(const Snapshot& snapshot, const Body& body) {
  const Model& model = snapshot.model();
  const Dofs& velocity = snapshot.state().reduced_momentum;
  double energy = 0;
  if (body.kind == BodyKind::rigid) {
    const double* v = rigid_values(body, velocity);
    for (int c = 0; c < 3; ++c) energy += 0.5 * model.rigid_bodies[body.rigid].dof[c].mass * v[c] * v[c];
    return energy;
  }
  const std::vector<double>& mass_at_unit_density = model.shape_of(body).space.mass_at_unit_density;
  const Points y = dof_values(model, body, velocity), v = dof_values(model, body, snapshot.velocities());
  double mass = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    energy += 0.5 * mass_at_unit_density[i] * y[i].dot(v[i]), mass += mass_at_unit_density[i];
  return body.mass / mass * energy;
}

Samples kinetic_energy(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(1);
  for (int b : selection.bodies) samples.add(1, {kinetic_energy_of(snapshot, snapshot.model().bodies[b])});
  return samples;
}

Samples temperature_rises(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(1);
  for (int b : selection.bodies) samples.add(1, {temperature_rise(snapshot.model(), b, snapshot.state().memory.heat)});
  return samples;
}

Samples strain_energy(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(1);
  for (int b : selection.bodies) {
    double energy = 0;
    for (const PointState& p :
         point_states(snapshot.model(), snapshot.model().bodies[b], snapshot.state().position, snapshot.state().memory))
      energy += p.weight * p.energy;
    samples.add(1, {energy});
  }
  return samples;
}

}  // namespace

std::vector<ProbeFunction> energy_functions() {
  return {{"energy", energy},
          {"works", works},
          {"temperature_rise", temperature_rises},
          {"kinetic_energy", kinetic_energy},
          {"strain_energy", strain_energy}};
}

}  // namespace pliant
