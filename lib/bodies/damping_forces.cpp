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

double drag_coefficient(const RigidDof& dof, const Instant& at) {
  return dof.mass_damping * dof.mass + (contains(dof.window, at) ? dof.damping : 0.0);
}

void add_rigid_drag(const RigidBody& rigid, const Instant& at, const double* velocity, double* force) {
  for (int c = 0; c < 3; ++c) force[c] -= drag_coefficient(rigid.dof[c], at) * velocity[c];
}

void add_drag(const Model& model, const Instant& at, const Dofs& velocity, Dofs& force) {
  parallel_for(static_cast<int>(model.regions.size()), [&](int r) {
    const Region& region = model.regions[r];
    const Batch& batch = model.batches[region.batch];
    if (!batch.mass_damped) return;
    const Lanes factor = batch.mass_damping * batch.density;
    with_nodes(model, batch, [&](const auto& nodes) {
      for (int i = 2 * region.first; i < 2 * region.last; ++i) {
        const std::size_t at_dof = batch.offset + static_cast<std::size_t>(i);
        force.compliant[at_dof] -= factor * nodes.unit_mass[i / 2] * velocity.compliant[at_dof];
      }
    });
  });
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    add_rigid_drag(model.rigid_bodies[r], at, &velocity.rigid[3 * r], &force.rigid[3 * r]);
}

bool has_drag(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [&](const Body& body) { return has_drag(model, body); });
}

bool has_drag(const Model& model, const Body& body) {
  if (body.kind == BodyKind::compliant) return model.scene.materials[body.material].mass_damping > 0;
  const RigidBody& rigid = model.rigid_bodies[body.rigid];
  return std::any_of(rigid.dof, rigid.dof + 3,
                     [](const RigidDof& dof) { return dof.damping > 0 || dof.mass_damping > 0; });
}

}  // namespace pliant
