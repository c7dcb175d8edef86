#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/node_arrays.hpp"

namespace pliant {

/// Calls update(i, dof) for each degree of freedom of a rigid body, i its index in Dofs::rigid.
template <class Update>
void for_each_dof_of(const Model& model, int rigid, Update&& update) {
  const auto r = static_cast<std::size_t>(rigid);
  for (std::size_t c = 0; c < 3; ++c) update(3 * r + c, model.rigid_bodies[r].dof[c]);
}

/// The same for all own rigid bodies.
template <class Update>
void for_each_rigid_dof(const Model& model, Update&& update) {
  for (int r : model.own.rigid_bodies) for_each_dof_of(model, r, update);
}

/// Calls compliant(i, inverse_mass) for each compliant degree of freedom of own bodies, i its index in Dofs::compliant,
/// and rigid(i, dof) for each rigid one. Threads share the bodies; updates may touch index i only.
template <class CompliantUpdate, class RigidUpdate>
void for_each_dof(const Model& model, CompliantUpdate&& compliant, RigidUpdate&& rigid,
                  const LoopPlace& place = LoopPlace::current()) {
  const OwnBodies& own = model.own;
  const auto of_region = [&](int number) {
    const Region& region = model.regions[own.regions[number]];
    const Batch& batch = model.batches[region.batch];
    with_nodes(model, batch, [&](auto nodes) {
      const Lanes inverse_density = batch.inverse_density;  // a copy, which the writes of updates cannot alias
      std::size_t i = batch.offset + 2 * static_cast<std::size_t>(region.first);
      for (int slot = region.first; slot < region.last; ++slot) {
        const Lanes inverse_mass = nodes.inverse_mass_at_unit_density[slot] * inverse_density;
        compliant(i++, inverse_mass);
        compliant(i++, inverse_mass);
      }
    });
  };
  parallel_for(
      static_cast<int>(own.regions.size()), of_region, static_cast<int>(own.rigid_bodies.size()),
      [&](int number) { for_each_dof_of(model, own.rigid_bodies[number], rigid); }, place);
}

}  // namespace pliant
