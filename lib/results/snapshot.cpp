#include "results/snapshot.hpp"

#include <algorithm>

#include "bodies/for_each_dof.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "core/parallel.hpp"

namespace pliant {

const std::vector<TouchingPair>& Snapshot::contacts() const {
  if (!contacts_) contacts_ = inspect_contacts(model(), contact(), state().outlines, state().memory.contact);
  return *contacts_;
}

const std::vector<int>& Snapshot::contact_counts() const {
  if (contact_counts_) return *contact_counts_;
  contact_counts_.emplace(model().bodies.size(), 0);
  for (const TouchingPair& pair : contacts()) {
    if (pair.of_itself()) continue;
    for (int body : {pair.first, pair.second}) ++(*contact_counts_)[body];
  }
  return *contact_counts_;
}

const std::vector<Fragment>& Snapshot::fragments() const {
  if (!fragments_) fragments_ = find_fragments(model(), bonds(), state().memory.bonds);
  return *fragments_;
}

const std::vector<int>& Snapshot::fragment_numbers() const {
  if (!fragment_numbers_) fragment_numbers_ = pliant::fragment_numbers(model(), fragments());
  return *fragment_numbers_;
}

const Dofs& Snapshot::velocities() const {
  if (!model().has_reciprocal_mass) return state().reduced_momentum;
  if (!velocities_) velocities_ = material_velocity(model(), state().reduced_momentum);
  return *velocities_;
}

const Dofs& Snapshot::accelerations() const {
  if (accelerations_) return *accelerations_;
  Dofs& a = accelerations_.emplace(zero_dofs(model()));
  const Dofs& force = state().force;
  for_each_dof(
      model(), [&](std::size_t i, Lanes inverse_mass) { a.compliant[i] = inverse_mass * force.compliant[i]; },
      [&](std::size_t i, const RigidDof& dof) { a.rigid[i] = dof.acceleration_of(state().time, force.rigid[i]); });
  return a = material_velocity(model(), a);
}

const Dofs& Snapshot::internal_forces() const {
  if (internal_forces_) return *internal_forces_;
  Dofs& f = internal_forces_.emplace(zero_dofs(model()));
  parallel_for(static_cast<int>(model().batches.size()), [&](int b) {
    const Batch& batch = model().batches[b];
    add_internal_forces(model(), batch, motion_of(batch, state().position, state().memory), &f.compliant[batch.offset]);
  });
  return f;
}

const EnergyBalance& Snapshot::energy_balance() const {
  if (!audit_) audit_ = simulation_.energy_balance();
  return *audit_;
}

}  // namespace pliant
