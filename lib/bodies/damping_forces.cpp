#include "bodies/damping_forces.hpp"

#include <algorithm>

#include "bodies/node_arrays.hpp"
#include "bodies/spread_forces.hpp"
#include "materials/kelvin_voigt.hpp"

namespace pliant {
namespace {

/// Deformation gradient and its rate.
struct Gradients {
  Tensor<Lanes> F{}, rate{};
};

/// Vector: Vec2 or LaneVector, as Table: IntegrationTable or LaneTable.
template <class Vector>
inline void add_outer(Tensor<Lanes>& sum, Lanes x, Lanes y, const Vector& b) {
  sum.xx += x * b.x();
  sum.xy += x * b.y();
  sum.yx += y * b.x();
  sum.yy += y * b.y();
}

template <class Table>
inline Gradients gradients(const Table& table, std::size_t point, const Lanes* q, const Lanes* v) {
  Gradients result;
  for (int e = table.start[point]; e < table.start[point + 1]; ++e) {
    const int i = 2 * table.node[e];
    add_outer(result.F, q[i], q[i + 1], table.gradient[e]);
    add_outer(result.rate, v[i], v[i + 1], table.gradient[e]);
  }
  return result;
}

template <class Table>
Lanes add_in_lanes(const Table& table, Lanes viscosity, const Lanes* positions, const Lanes* velocities,
                   Lanes* forces) {
  Lanes power{};
  for (std::size_t point = 0; point < table.weight.size(); ++point) {
    const Gradients at = gradients(table, point, positions, velocities);
    const KelvinVoigt rate(at.F, at.rate);
    const Lanes factor = 2.0 * table.weight[point] * viscosity;
    power += factor * rate.square();
    const Tensor<Lanes> P = rate.stress(at.F, factor);
    for (int e = table.start[point]; e < table.start[point + 1]; ++e) {
      const auto& b = table.gradient[e];
      Lanes* f = forces + 2 * table.node[e];
      f[0] -= P.xx * b.x() + P.xy * b.y();
      f[1] -= P.yx * b.x() + P.yy * b.y();
    }
  }
  return power;
}

}  // namespace

Lanes add_viscous_forces(const Model& model, const Batch& batch, const Lanes* positions, const Lanes* velocities,
                         Lanes* forces) {
  if (batch.layout == Layout::spread) return add_spread_viscous_forces(model, batch, positions, velocities, forces);
  return with_tables(model, batch, [&](const auto& tables) {
    return add_in_lanes(tables.table, batch.viscosity, positions, velocities, forces);
  });
}

double viscous_power(const Model& model, const Batch& batch, const Lanes* positions, const Lanes* velocities,
                     Lanes* forces) {
  return batch.viscous ? sum(batch.weight * add_viscous_forces(model, batch, positions, velocities, forces)) : 0.0;
}

double add_mass_damping(const Model& model, const Region& region, const Lanes* velocities, Lanes* forces) {
  const Batch& batch = model.batches[region.batch];
  if (!batch.mass_damped) return 0;
  const Lanes factor = batch.mass_damping * batch.density;
  return with_nodes(model, batch, [&](const auto& nodes) {
    Lanes power{};
    for (int i = 2 * region.first; i < 2 * region.last; ++i) {
      const Lanes force = factor * nodes.unit_mass[i / 2] * velocities[i];
      forces[i] -= force;
      power += force * velocities[i];
    }
    return sum(power * batch.weight);
  });
}

double add_rigid_damping(const RigidBody& rigid, double time, const double* velocity, double* force) {
  double power = 0;
  for (int c = 0; c < 3; ++c) {
    const RigidDof& dof = rigid.dof[c];
    const double resistance = dof.mass_damping * dof.mass + (dof.window.contains(time) ? dof.damping : 0.0);
    force[c] -= resistance * velocity[c];
    power += resistance * velocity[c] * velocity[c];
  }
  return power;
}

double damping_rate(const RigidBody& rigid) {
  double rate = 0;
  for (const RigidDof& dof : rigid.dof)
    if (dof.inverse_mass > 0) rate = std::max(rate, dof.mass_damping + dof.damping * dof.inverse_mass);
  return rate;
}

}  // namespace pliant
