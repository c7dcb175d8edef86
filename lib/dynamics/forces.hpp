#pragma once

#include <functional>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/nodewise_forces.hpp"
#include "bodies/outline_fields.hpp"
#include "bonds/bond_system.hpp"
#include "contact/contact.hpp"
#include "core/phase_times.hpp"
#include "dynamics/state.hpp"

namespace pliant {

/// Sums and checks of one force evaluation.
struct Evaluation {
  PairTotals contact;
  BondTotals bonds;
  double damping_power = 0;  ///< power of viscosity, Maxwell branches and the dashpots of contacts and supports, W/m
  double material_loss = 0;  ///< dissipated in the step by plastic flow, J/m
  double least_jacobian = 1e300;
  bool contact_lost = false;  ///< some penetration is beyond what is allowed
  bool valid = true;  ///< false: the trial must be rejected, for J <= 0, deep penetration, or moves beyond the skin
};

/// Functions of an integrator for Forces::evaluate_and_update: the update of a region, by its index in Model::regions,
/// and of a rigid body. Several threads call them at once. Pass closures by std::cref: copies would be allocated in
/// every step.
struct BodyUpdates {
  std::function<void(int region)> region;
  std::function<void(int rigid)> rigid;
};

/// All forces on all degrees of freedom for given positions.
class Forces {
 public:
  explicit Forces(const Model& model);

  /// Result of the check of the contact candidates.
  struct ListCheck {
    bool rebuilt = false;  ///< candidates or bonds are others than before
    bool valid = true;     ///< false for a trial that exceeds the skin in a single step
  };
  /// Makes the bonds whose time has come, and makes sure that the candidates are valid for the outlines of a trial that
  /// ends at `time`. If they are not, they
  /// are rebuilt at the accepted state. Its history is stored in a new order and keeps its records, so that a rejected
  /// trial loses none.
  ListCheck ensure_candidates(State& accepted, const OutlineField& trial, double time);

  /// Output of an evaluation.
  struct Output {
    Dofs& force;                  ///< all except mass damping (bodies/damping_forces.hpp), which the integrator adds
    OutlineField& contact_force;  ///< N/m
    Memory& memory;               ///< history variables at these positions
  };
  /// All forces of a motion with these outlines, from the history variables `from`.
  Evaluation evaluate(const Motion& motion, const Outlines& outlines, const PreviousHistory& from, const Output& to) {
    return evaluate_and_update(motion, outlines, from, to, {});
  }
  /// Fused kernel: updates each region and rigid body while its forces are in the cache. It means `evaluate`, then
  /// update.region(r) for all regions and update.rigid(r) for all rigid bodies.
  Evaluation evaluate_and_update(const Motion& motion, const Outlines& outlines, const PreviousHistory& from,
                                 const Output& to, const BodyUpdates& update);

  /// With a fixed rebuild interval: warns once per run if contacts may be missed in this state.
  void warn_of_missed_contacts(const State& state) { contact_.warn_of_missed_contacts(state.outlines.position); }
  /// Warns once per run of deep contacts, after an evaluation that is accepted.
  void warn_of_depth(const Evaluation& evaluation, double time);

  /// As ContactSystem::inherit and BondSystem::inherit.
  void inherit(const InheritedContact& contact, const InheritedBonds& bonds, Memory& memory) {
    contact_.inherit(contact, memory.contact), bonds_.inherit(bonds, memory.bonds);
  }

  const Model& model() const { return model_; }
  const ContactSystem& contact() const { return contact_; }
  const BondSystem& bonds() const { return bonds_; }
  PhaseTimes& phases() { return phases_; }

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("contact", contact_);
    visitor("bonds", bonds_);
    visitor("warned_deep", warned_deep_);
  }

 private:
  BatchMotion step_of(const Batch& batch, const Motion& motion, const PreviousHistory& from, Memory& to) const;
  void lane_forces(int b, const Motion& motion, const OutlineField& on_outlines, const PreviousHistory& from,
                   const Output& to);
  void rigid_forces(int r, const Motion& motion, const OutlineField& position, const OutlineField& on_outlines,
                    Dofs& force);
  void nodewise_forces(const Motion& motion, const OutlineField& on_outlines, const PreviousHistory& from,
                       const Output& to, const BodyUpdates& update);

  const Model& model_;
  ContactSystem contact_;
  BondSystem bonds_;
  OutlineField outline_force_;          ///< sum of contact forces and loads on outlines; empty without such loads
  std::vector<double> least_jacobian_;  ///< [batches of several bodies, chunks of points]
  /// Of materials, as least_jacobian_, W/m: one lane a body, or all one body; empty without rates and internal
  /// variables.
  std::vector<Lanes> damping_power_;
  std::vector<Lanes> material_loss_;  ///< in the step, as damping_power_, J/m; empty without laws that have one
  std::vector<std::vector<StressColumns>> stresses_;  ///< [nodewise bodies][points]
  bool warned_deep_ = false;
  PhaseTimes phases_;
};

}  // namespace pliant
