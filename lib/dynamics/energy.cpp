#include "dynamics/energy.hpp"

#include <algorithm>
#include <cmath>

#include <spdlog/spdlog.h>

#include "bodies/initial_state.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/node_arrays.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "bodies/small_strain.hpp"
#include "boundary/loads.hpp"
#include "boundary/outline_loads.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Displacement gradients up to which the error of linear elasticity is some percent.
constexpr double small_strain = 0.03;

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0.0; }

}  // namespace

double kinetic_energy(const Model& model, const Dofs& velocity) {
  Dofs scratch;
  const Dofs& moving = material_velocity(model, velocity, scratch);
  double total = ordered_sum(static_cast<int>(model.regions.size()), [&](int r) {
    const Region& region = model.regions[r];
    const Batch& batch = model.batches[region.batch];
    const Lanes *y = &velocity.compliant[batch.offset], *v = &moving.compliant[batch.offset];
    return with_nodes(model, batch, [&](const auto& nodes) {
      Lanes energy{};
      for (int i = region.first; i < region.last; ++i)
        energy += 0.5 * nodes.mass_at_unit_density[i] * (y[2 * i] * v[2 * i] + y[2 * i + 1] * v[2 * i + 1]);
      return sum(energy * batch.density * batch.weight);
    });
  });
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    for (std::size_t c = 0; c < 3; ++c) {
      const double v = velocity.rigid[3 * r + c];
      total += 0.5 * model.rigid_bodies[r].dof[c].mass * v * v;
    }
  return total;
}

EnergyAccountant::EnergyAccountant(const Model& model, const State& start) : model_(model) {
  gravity_start_ = constant_gravity_moment(start.position);
  energy_start_ = audit(start).energy.mechanical();
}

/// Moment of constant gravity; 0 with a history, whose work is added step by step.
double EnergyAccountant::constant_gravity_moment(const Dofs& position) const {
  const Scene& scene = model_.scene;
  return scene.gravity_history.empty() ? gravity_moment(model_, scene.gravity, position) : 0;
}

void EnergyAccountant::warn_of_strain(const State& state) {
  if (warned_of_strain_) return;
  const double strain = largest_small_strain(model_, state.position);
  if (strain <= small_strain) return;
  warned_of_strain_ = true;
  spdlog::warn(
      "displacement gradients of \"linear-elastic\" bodies reach {:.2g} at t = {:.6g} s: the law is a check for small "
      "strains and rotations, some percent at most; take \"neo-hookean\"",
      strain, state.time);
}

EnergyBalance EnergyAccountant::audit(const State& state) {
  warn_of_strain(state);
  EnergyBalance result;
  result.contacts = static_cast<int>(state.contacts);
  result.energy.contact = state.contact_energy;
  result.energy.kinetic = kinetic_energy(model_, state.reduced_momentum);
  std::vector<double> strain(model_.batches.size());
  for_each_batch(model_, [&](int b) {
    strain[b] =
        sum(strain_energy(model_, model_.batches[b], motion_of(model_.batches[b], state.position, state.memory)));
  });
  result.energy.strain = ordered_sum(static_cast<int>(strain.size()), [&](int b) { return strain[b]; });
  result.energy.boundary = support_energy(model_, state.outlines.position, {state.time});
  result.energy.dissipated = state.dissipated;
  result.energy.external_work =
      state.external_work + state.gravity_work + constant_gravity_moment(state.position) - gravity_start_;
  result.momentum_error = std::max(contact_imbalance(state), internal_imbalance(state));
  return result;
}

double EnergyAccountant::energy_gained(const Energies& energy) const {
  return energy.mechanical() - energy_start_ - energy.external_work + energy.dissipated;
}

double EnergyAccountant::balance_error(const Energies& energy) const {
  return ratio(std::abs(energy_gained(energy)),
               std::max({std::abs(energy.external_work), std::abs(energy_start_), energy.dissipated}));
}

/// Imbalance of contact forces on all outlines: their sum and their moment about the origin. Between periodic images a
/// force's lever changes by whole periods, so moments count here only without a period. The tests take them pair by
/// pair.
double EnergyAccountant::contact_imbalance(const State& state) const {
  const OutlineField &at = state.outlines.position, &force = state.contact_force;
  double fx = 0, fy = 0, moment = 0, magnitude = 0, lever = 0;
  for (std::size_t b = 0; b < model_.bodies.size(); ++b)
    for (int i = model_.outline_offset[b]; i < model_.outline_offset[b] + model_.outline_of(static_cast<int>(b)).count;
         ++i) {
      fx += force.x[i], fy += force.y[i];
      moment += at.x[i] * force.y[i] - at.y[i] * force.x[i];
      magnitude += std::hypot(force.x[i], force.y[i]);
      lever += std::abs(at.x[i] * force.y[i]) + std::abs(at.y[i] * force.x[i]);
    }
  const double linear = ratio(std::hypot(fx, fy), magnitude);
  return model_.scene.is_periodic() ? linear : std::max(linear, ratio(std::abs(moment), lever));
}

double EnergyAccountant::internal_imbalance(const State& state) const {
  std::vector<double> imbalance(model_.batches.size());
  for_each_batch(model_, [&](int b) {
    const Batch& batch = model_.batches[b];
    const std::size_t slots = static_cast<std::size_t>(batch.slots);
    std::vector<Lanes> f(2 * slots, Lanes{});
    const Lanes* q = &state.position.compliant[batch.offset];
    add_internal_forces(model_, batch, motion_of(batch, state.position, state.memory), f.data());
    Lanes fx{}, fy{}, moment{}, magnitude = broadcast(1e-300), lever = broadcast(1e-300);
    for (std::size_t i = 0; i < slots; ++i) {
      fx += f[2 * i], fy += f[2 * i + 1];
      magnitude += abs(f[2 * i]) + abs(f[2 * i + 1]);
      moment += q[2 * i] * f[2 * i + 1] - q[2 * i + 1] * f[2 * i];
      lever += abs(q[2 * i] * f[2 * i + 1]) + abs(q[2 * i + 1] * f[2 * i]);
    }
    for (Lanes* total : {&fx, &fy, &moment, &magnitude, &lever}) *total = sum_over_body(batch, *total);
    // Rounding in an unloaded grain is no imbalance: forces count relative to the elastic scale of the grain.
    const Body& body = model_.bodies[model_.groups[batch.group].bodies[batch.first]];
    const double size = std::sqrt(body.area) / body.scale;
    const Lanes floor = batch.mu * (1e-3 * size);
    const Lanes linear = max(abs(fx), abs(fy)) / max(magnitude, floor);
    imbalance[b] = largest(max(linear, abs(moment) / max(lever, floor * size)));
  });
  return imbalance.empty() ? 0 : *std::max_element(imbalance.begin(), imbalance.end());
}

}  // namespace pliant
