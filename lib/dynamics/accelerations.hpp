#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "core/parallel.hpp"

namespace pliant {

/// Calls update(i, dof) for each rigid degree of freedom, i its index in Dofs::rigid.
template <class Update>
void for_each_rigid_dof(const Model& model, Update&& update) {
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    for (std::size_t c = 0; c < 3; ++c) update(3 * r + c, model.rigid_bodies[r].dof[c]);
}

/// Calls compliant(i, inverse_mass) for each compliant degree of freedom, i its index in Dofs::compliant, and rigid(i, dof) for each rigid one.
/// The bodies are shared out over the threads; updates touch only index i.
template <class CompliantUpdate, class RigidUpdate>
void for_each_dof(const Model& model, CompliantUpdate&& compliant, RigidUpdate&& rigid) {
  parallel_for(static_cast<int>(model.batches.size()), [&](int b) {
    const Batch& batch = model.batches[b];
    const std::vector<double>& inverse_unit_mass = model.shape_of(batch).inverse_unit_mass;
    std::size_t i = batch.offset;
    for (double inverse : inverse_unit_mass) {
      const Lanes inverse_mass = inverse * batch.inverse_density;
      compliant(i++, inverse_mass);
      compliant(i++, inverse_mass);
    }
  });
  for_each_rigid_dof(model, rigid);
}

}  // namespace pliant
