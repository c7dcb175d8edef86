#include "dynamics/body_energy_correction.hpp"

#include <algorithm>

#include "bodies/damping_forces.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/node_arrays.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "boundary/loads.hpp"
#include "materials/with_law.hpp"

namespace pliant {
namespace {

/// Whether only contacts and a potential do work on the body, and nothing else dissipates its energy.
bool is_corrected(const Model& model, int body) {
  const Batch& batch = model.batches[model.bodies[body].batch];
  const auto on_body = [&](const auto& condition) { return condition.body == body; };
  const bool law_dissipates = with_law_type<double>(model.groups[batch.group].law,
                                                    []<class Law>(std::type_identity<Law>) { return dissipates<Law>; });
  return !law_dissipates && batch.viscosity[model.bodies[body].lane] == 0 &&
         !has_mass_damping(model, model.bodies[body]) && std::ranges::none_of(model.pressures, on_body) &&
         std::ranges::none_of(model.supports, on_body);
}

/// Rigid motion that fits the velocities `v` of each body of a batch best, weighted by lumped mass.
struct RigidMotion {
  Lanes x{}, y{}, velocity_x{}, velocity_y{}, spin{};

  template <class Nodes>
  RigidMotion(const Batch& batch, const Nodes& nodes, const Lanes* q, const Lanes* v) {
    Lanes mass{};
    for (int i = 0; i < batch.slots; ++i) {
      mass += nodes.mass_at_unit_density[i];
      x += nodes.mass_at_unit_density[i] * q[2 * i], y += nodes.mass_at_unit_density[i] * q[2 * i + 1];
      velocity_x += nodes.mass_at_unit_density[i] * v[2 * i],
          velocity_y += nodes.mass_at_unit_density[i] * v[2 * i + 1];
    }
    mass = sum_over_body(batch, mass);
    for (Lanes* mean : {&x, &y, &velocity_x, &velocity_y}) *mean = sum_over_body(batch, *mean) / mass;
    Lanes momentum{}, inertia{};
    for (int i = 0; i < batch.slots; ++i) {
      const Lanes rx = q[2 * i] - x, ry = q[2 * i + 1] - y;
      momentum += nodes.mass_at_unit_density[i] * (rx * (v[2 * i + 1] - velocity_y) - ry * (v[2 * i] - velocity_x));
      inertia += nodes.mass_at_unit_density[i] * (rx * rx + ry * ry);
    }
    spin = sum_over_body(batch, momentum) / sum_over_body(batch, inertia);
  }

  /// Velocity of a node without the rigid motion.
  LaneVector without(const Lanes* q, const Lanes* v) const {
    return {v[0] - velocity_x + spin * (q[1] - y), v[1] - velocity_y - spin * (q[0] - x)};
  }
};

/// K - dt^2 sum F^2/(8 m) + (dt^2 sum F F_before/m - sum dx dF)/12 of each body of a batch after a step, J/m; for a
/// nodewise body the lanes add up to it. The last terms have displacements and forces relative to the body's mean ones.
/// The mean motion keeps the first two terms, and its share of the others would make the error depend on the frame of
/// reference.
Lanes shadow_kinetic_energy(const Model& model, const Batch& batch, const Trial& before, const State& state,
                            double dt) {
  const Lanes *y = &state.reduced_momentum.compliant[batch.offset], *f = &state.force.compliant[batch.offset],
              *old_f = &before.force.compliant[batch.offset], *q = &state.position.compliant[batch.offset],
              *old_q = &before.position.compliant[batch.offset];
  const std::size_t size = 2 * static_cast<std::size_t>(batch.slots);
  thread_local std::vector<Lanes> impulse, less, scratch;  // memory is allocated once
  impulse.resize(size), less.resize(size), scratch.resize(size);
  return with_nodes(model, batch, [&](const auto& nodes) {
    Lanes mass{}, mean_displacement[2]{}, old_mean[2]{};
    for (int slot = 0; slot < batch.slots; ++slot) {
      mass += nodes.mass_at_unit_density[slot];
      for (int c = 0; c < 2; ++c) {
        const int i = 2 * slot + c;
        mean_displacement[c] += nodes.mass_at_unit_density[slot] * (q[i] - old_q[i]), old_mean[c] += old_f[i];
      }
    }
    mass = sum_over_body(batch, mass);
    for (int c = 0; c < 2; ++c) {
      mean_displacement[c] = sum_over_body(batch, mean_displacement[c]) / mass;
      old_mean[c] = sum_over_body(batch, old_mean[c]) / mass;
    }
    Lanes change{};
    for (std::size_t i = 0; i < size; ++i) {
      const Lanes half_step = 0.5 * dt * (nodes.inverse_mass_at_unit_density[i / 2] * batch.inverse_density);
      impulse[i] = half_step * f[i];
      less[i] = half_step * (f[i] - 2.0 / 3 * (old_f[i] - nodes.mass_at_unit_density[i / 2] * old_mean[i % 2]));
      change += (q[i] - old_q[i] - mean_displacement[i % 2]) * (f[i] - old_f[i]);
    }
    const auto product = [&](const Lanes* a, const Lanes* b) {  // product of reduced momenta, weighted by mass
      if (model.has_reciprocal_mass) apply_reciprocal_mass(model, batch, b, scratch.data()), b = scratch.data();
      Lanes total{};
      for (std::size_t i = 0; i < size; ++i) total += nodes.mass_at_unit_density[i / 2] * (a[i] * b[i]);
      return total;
    };
    const Lanes twice = product(y, y) - product(impulse.data(), less.data());
    return batch.weight * (0.5 * batch.density * twice - 1.0 / 12 * change);
  });
}

/// Removes the corrected share of the energy error `error`, J/m, from the vibrations of a batch's bodies. Velocities
/// are v = C y, and u is what their rigid motion leaves of them. y becomes y - t u. This changes neither momentum nor
/// angular momentum, leaves a rigid motion as it is, and takes t u.D u of kinetic energy for small t.
void scale_vibrations(const Model& model, const Batch& batch, Lanes error, State& state) {
  const Lanes* q = &state.position.compliant[batch.offset];
  Lanes* y = &state.reduced_momentum.compliant[batch.offset];
  const Lanes* v = y;
  thread_local std::vector<Lanes> scratch;  // memory is allocated once
  if (model.has_reciprocal_mass) {
    scratch.resize(2 * static_cast<std::size_t>(batch.slots));
    apply_reciprocal_mass(model, batch, y, scratch.data());
    v = scratch.data();
  }
  with_nodes(model, batch, [&](const auto& nodes) {
    const RigidMotion rigid(batch, nodes, q, v);
    Lanes twice{};  // twice their kinetic energy
    for (int i = 0; i < batch.slots; ++i) {
      const LaneVector shaking = rigid.without(&q[2 * i], &v[2 * i]);
      twice += nodes.mass_at_unit_density[i] * (shaking.x() * shaking.x() + shaking.y() * shaking.y());
    }
    twice = sum_over_body(batch, twice * batch.density * batch.weight);
    error = select(abs(error) < 0.5 * largest_error_of_bodies * twice, error, Lanes{});
    const Lanes wanted = corrected_share * error / max(twice, broadcast(1e-300));
    const Lanes taken =
        max(min(wanted, broadcast(largest_correction_of_bodies)), broadcast(-largest_correction_of_bodies));
    for (int i = 0; i < batch.slots; ++i) {
      const LaneVector shaking = rigid.without(&q[2 * i], &v[2 * i]);
      // 0 in padding
      const Lanes there = taken * (nodes.mass_at_unit_density[i] * nodes.inverse_mass_at_unit_density[i]);
      y[2 * i] -= there * shaking.x(), y[2 * i + 1] -= there * shaking.y();
    }
  });
}

/// Work of the mean contact forces on a body's outline in a step, J/m.
double contact_work(const Model& model, int body, const Trial& before, const State& after) {
  const OutlineField &old_place = before.outlines.position, &place = after.outlines.position,
                     &old_force = before.contact_force, &force = after.contact_force;
  Lanes twice{};
  for (int i = model.outline_offset[body], end = model.outline_end(body); i < end; i += lane_count) {
    const Lanes work = (load(&old_force.x[i]) + load(&force.x[i])) * (load(&place.x[i]) - load(&old_place.x[i])) +
                       (load(&old_force.y[i]) + load(&force.y[i])) * (load(&place.y[i]) - load(&old_place.y[i]));
    twice += select(first_lanes(end - i), work, Lanes{});
  }
  return 0.5 * sum(twice);
}

}  // namespace

BodyEnergyCorrection::BodyEnergyCorrection(const Model& model) : model_(model) {
  if (!model.scene.corrects_energy() || !model.scene.gravity_history.empty()) return;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.batch < 0 || !is_corrected(model, static_cast<int>(b))) continue;
    corrected_.resize(model.batches.size());
    if (model.batches[body.batch].layout == Layout::nodewise)
      corrected_[body.batch] = broadcast(1);
    else
      corrected_[body.batch][body.lane] = 1;
  }
  if (!is_active()) return;
  for (const int b : model.own.bodies)
    if (const Body& body = model.bodies[b]; body.batch >= 0 && corrected_[body.batch][body.lane] > 0)
      bodies_.push_back(b);
}

void BodyEnergyCorrection::add_work(const Trial& before, State& state) const {
  if (state.body_balance.work.empty()) return;
  parallel_for(static_cast<int>(bodies_.size()),
               [&](int i) { state.body_balance.work[bodies_[i]] += contact_work(model_, bodies_[i], before, state); });
}

/// Kinetic, strain and gravitational energy of each body of a batch, J/m.
Lanes BodyEnergyCorrection::energy(const Trial& before, const State& state, int b, double dt) const {
  const Batch& batch = model_.batches[b];
  return sum_over_body(batch, shadow_kinetic_energy(model_, batch, before, state, dt) +
                                  strain_energy(model_, batch, motion_of(batch, state.position, state.memory)) -
                                  gravity_moment(model_, batch, model_.scene.gravity, state.position));
}

Lanes BodyEnergyCorrection::error(const Trial& before, const State& state, int b, double dt) const {
  const Batch& batch = model_.batches[b];
  const int* bodies = &model_.groups[batch.group].bodies[batch.first];
  Lanes work = broadcast(state.body_balance.work[bodies[0]]);  // in all lanes for a nodewise body
  for (int lane = 1; lane < batch.count; ++lane) work[lane] = state.body_balance.work[bodies[lane]];
  return energy(before, state, b, dt) - state.body_balance.opening[b] - work;
}

void BodyEnergyCorrection::correct(const Trial& before, State& state, double dt) const {
  if (state.steps % correction_period != 0) return;
  if (state.body_balance.opening.empty()) {
    state.body_balance.work.resize(model_.bodies.size());
    state.body_balance.opening.resize(model_.batches.size());
    return for_each_batch(model_, [&](int b) { state.body_balance.opening[b] = energy(before, state, b, dt); });
  }
  for_each_batch(model_, [&](int b) {
    if (sum(corrected_[b]) > 0)
      scale_vibrations(model_, model_.batches[b], corrected_[b] * error(before, state, b, dt), state);
  });
}

}  // namespace pliant
