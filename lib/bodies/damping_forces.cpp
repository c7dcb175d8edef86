#include "bodies/damping_forces.hpp"

#include <algorithm>

#include "bodies/node_arrays.hpp"

namespace pliant {
double damping_coefficient(const RigidDof& dof, const Instant& at) {
  return dof.mass_damping * dof.mass + (contains(dof.window, at) ? dof.damping : 0.0);
}

void add_rigid_damping(const RigidBody& rigid, const Instant& at, const double* velocity, double* force) {
  for (int c = 0; c < 3; ++c) force[c] -= damping_coefficient(rigid.dof[c], at) * velocity[c];
}

void add_mass_damping(const Model& model, const Instant& at, const Dofs& velocity, Dofs& force) {
  parallel_for(static_cast<int>(model.regions.size()), [&](int r) {
    const Region& region = model.regions[r];
    const Batch& batch = model.batches[region.batch];
    if (!batch.mass_damped) return;
    const Lanes factor = batch.mass_damping * batch.density;
    with_nodes(model, batch, [&](const auto& nodes) {
      for (int i = 2 * region.first; i < 2 * region.last; ++i) {
        const std::size_t at_dof = batch.offset + static_cast<std::size_t>(i);
        force.compliant[at_dof] -= factor * nodes.mass_at_unit_density[i / 2] * velocity.compliant[at_dof];
      }
    });
  });
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    add_rigid_damping(model.rigid_bodies[r], at, &velocity.rigid[3 * r], &force.rigid[3 * r]);
}

bool has_mass_damping(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [&](const Body& body) { return has_mass_damping(model, body); });
}

bool has_mass_damping(const Model& model, const Body& body) {
  if (body.kind == BodyKind::compliant) return model.scene.materials[body.material].mass_damping > 0;
  const RigidBody& rigid = model.rigid_bodies[body.rigid];
  return std::any_of(rigid.dof, rigid.dof + 3,
                     [](const RigidDof& dof) { return dof.damping > 0 || dof.mass_damping > 0; });
}

}  // namespace pliant
