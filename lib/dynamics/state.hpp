#pragma once

#include <cstdint>
#include <vector>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "bodies/point_law.hpp"
#include "contact/energy_debt.hpp"
#include "contact/history.hpp"

namespace pliant {

/// What the forces of the next step depend on beside positions and velocities: committed on accepted steps only.
struct Memory {
  ContactHistory contact;
  std::vector<Lanes> material;  ///< [Model::material_memory], of integration points: Batch::memory

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("contact", contact);
    visitor("material", material);
  }
};

/// A memory, how long ago it was, and, if contact may know, where the outlines were then and what rigid bodies have
/// done since.
struct PreviousHistory {
  const Memory& memory;
  double elapsed = 0;  ///< s
  const OutlineField* outlines = nullptr;
  const RigidStep* rigid = nullptr;  ///< see StepStart
};

/// Before anything has happened.
Memory initial_memory(const Model& model);

/// The motion of a batch at a state's positions, with its memory, and at rest.
BatchMotion motion_of(const Batch& batch, const Dofs& position, const Memory& memory);

/// Of bodies that keep their energy (dynamics/body_debt.hpp); empty before the first settlement.
struct BodyBooks {
  std::vector<Lanes> opening;  ///< [batches] what bodies had when the books were opened, J/m
  std::vector<double> work;    ///< [bodies] of contacts since, J/m

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("opening", opening), visitor("work", work);
  }
};

/// The controller of `verlet` reads the largest error over dt^3, of this span of steps and of the last one, 1/s3.
struct ErrorHistory {
  double now = 0, before = 0;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("jerk", now), visitor("jerk_before", before);
  }
};

/// The numbers of a state that are no arrays.
struct StateNumbers {
  double time = 0;     ///< s
  double next_dt = 0;  ///< what the controller proposes, s
  ErrorHistory errors;
  double external_work = 0;   ///< of loads and imposed motions, J/m
  double gravity_work = 0;    ///< of a gravity with a history, J/m; 0 for a constant one, which has a potential
  double dissipated = 0;      ///< by contact laws and by damping, J/m
  double damped = 0;          ///< of that, by forces that depend on velocities, J/m
  double damping_power = 0;   ///< of viscosity and of the dashpots of contacts and supports, with `force`, W/m
  double contact_energy = 0;  ///< stored in contacts, J/m; with `contact_force`
  std::int64_t contacts = 0;  ///< nodes in touch
  std::int64_t steps = 0, rejections = 0, evaluations = 0;
};

/// What the motion of a run has become. It enumerates itself (core/archive.hpp), so that hash, comparison and
/// checkpoint cannot forget a part.
struct State : StateNumbers {
  Dofs position;          ///< m
  Dofs reduced_momentum;  ///< over lumped mass, m/s: the velocity, but with corrected mass (bodies/mass_correction.hpp)
  Dofs force;             ///< N/m
  Memory memory;
  BodyBooks books;
  // They go with the positions, and are no part of the motion, nor are contact_energy and contacts:
  Outlines outlines;           ///< with the velocities that dashpots saw
  OutlineField contact_force;  ///< on outline nodes, N/m

  /// visitor(name, value) for every member; arrays come as vectors.
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visit_motion(visitor);
    visitor("outlines", outlines);
    visitor("contact_force", contact_force);
    visitor("contact_energy", contact_energy);
    visitor("contacts", contacts);
  }
  template <class Visitor>
  void visit_motion(Visitor&& visitor) {
    visitor("time", time);
    visitor("next_dt", next_dt);
    errors.visit(visitor);
    visitor("external_work", external_work);
    visitor("gravity_work", gravity_work);
    visitor("dissipated", dissipated);
    visitor("damped", damped);
    visitor("damping_power", damping_power);
    visitor("steps", steps);
    visitor("rejections", rejections);
    visitor("evaluations", evaluations);
    visitor("position", position);
    visitor("reduced_momentum", reduced_momentum);
    visitor("force", force);
    visitor("memory", memory);
    visitor("books", books);
  }
};

/// 64-bit FNV-1a hash of every bit of the motion.
std::uint64_t state_hash(const State& state);

}  // namespace pliant
