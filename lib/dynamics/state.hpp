#pragma once

#include <cstdint>
#include <vector>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"
#include "bodies/point_law.hpp"
#include "bonds/bond.hpp"
#include "contact/energy_correction.hpp"
#include "contact/history.hpp"

namespace pliant {

/// History variables: all on which the forces of the next step depend besides positions and velocities. Committed on
/// accepted steps only.
struct Memory {
  ContactHistory contact;
  BondHistory bonds;
  std::vector<Lanes> material;  ///< of integration points, see Batch::memory
  std::vector<double> heat;     ///< [bodies] from dissipation, J/m (dynamics/body_heat.hpp); empty if nothing has one

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("contact", contact);
    visitor("bonds", bonds);
    visitor("material", material);
    visitor("heat", heat);
  }
};

/// History variables, the time since then, the outlines at that time and, for the energy correction of contacts, the
/// motion of rigid bodies since.
struct PreviousHistory {
  const Memory& memory;
  double dt = 0;  ///< s
  const OutlineField* outlines = nullptr;
  const RigidStep* rigid = nullptr;  ///< see StepStart
};

/// History variables at the start.
Memory initial_memory(const Model& model);

/// Motion of a batch at a state's positions, with its history variables, at rest.
BatchMotion motion_of(const Batch& batch, const Dofs& position, const Memory& memory);

/// Energy balance of bodies with energy correction (dynamics/body_energy_correction.hpp); empty before the first
/// correction.
struct BodyBalance {
  std::vector<Lanes> opening;  ///< [batches] energies of bodies at the start of the balance, J/m
  std::vector<double> work;    ///< [bodies] work of contacts since, J/m

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("opening", opening), visitor("work", work);
  }
};

/// The numbers of a state that are no arrays.
struct StateNumbers {
  double time = 0;            ///< s
  double external_work = 0;   ///< of loads and imposed motions, J/m
  double gravity_work = 0;    ///< of a gravity with a history, J/m; 0 for a constant one, which has a potential
  double dissipated = 0;      ///< by contact laws, bonds, damping and plastic flow, J/m
  double damped = 0;          ///< part of it by forces that depend on velocities, J/m
  double plastic_loss = 0;    ///< part of it by plastic flow, J/m
  double bond_loss = 0;       ///< part of it by damage of bonds, J/m
  double damping_power = 0;   ///< of viscosity and of the dashpots of contacts and supports, for `force`, W/m
  double contact_energy = 0;  ///< stored in contacts and bonds, J/m; for `contact_force`
  std::int64_t contacts = 0;  ///< active slave nodes; slave segments if integrated
  std::int64_t steps = 0, rejections = 0, evaluations = 0;
};

/// State of a run. It enumerates itself (core/archive.hpp), so that hash, comparison and checkpoint cannot omit a part.
struct State : StateNumbers {
  Dofs position;          ///< m
  Dofs reduced_momentum;  ///< over lumped mass, m/s: velocity if C = I (bodies/reciprocal_mass.hpp)
  Dofs force;             ///< N/m
  Memory memory;
  BodyBalance body_balance;
  Lattice cell_start;  ///< of the positions at the start of the run; 0 without two periods
  // The hash leaves these out, like contact_energy and contacts: they follow from the positions. It also leaves out the
  // contact forces of the last step (ContactHistory::last), which the energy correction of the next step needs.
  Outlines outlines;           ///< with the velocities that dashpots used
  OutlineField contact_force;  ///< on outline nodes, N/m

  /// Calls visitor(name, value) for every member; arrays are passed as vectors.
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visit_motion(visitor);
    visitor("outlines", outlines);
    visitor("contact_force", contact_force);
    visitor("contact_energy", contact_energy);
    visitor("contacts", contacts);
    visitor("last", memory.contact.last);
  }
  template <class Visitor>
  void visit_motion(Visitor&& visitor) {
    visitor("time", time);
    visitor("external_work", external_work);
    visitor("gravity_work", gravity_work);
    visitor("dissipated", dissipated);
    visitor("damped", damped);
    visitor("plastic_loss", plastic_loss);
    visitor("bond_loss", bond_loss);
    visitor("damping_power", damping_power);
    visitor("steps", steps);
    visitor("rejections", rejections);
    visitor("evaluations", evaluations);
    visitor("position", position);
    visitor("reduced_momentum", reduced_momentum);
    visitor("force", force);
    visitor("memory", memory);
    visitor("body_balance", body_balance);
    if (cell_start == Lattice{}) return;
    visitor("cell_start", cell_start);
    visitor("cell", position.lattice);
    visitor("cell_rate", reduced_momentum.lattice);
    visitor("cell_force", force.lattice);
  }
};

/// 64-bit FNV-1a hash of every bit of the motion.
std::uint64_t state_hash(const State& state);

}  // namespace pliant
