#pragma once

#include <functional>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "bodies/spread_forces.hpp"
#include "contact/contact.hpp"
#include "core/phase_times.hpp"
#include "dynamics/state.hpp"

namespace pliant {

/// What one force evaluation found.
struct Evaluation {
  PairTotals contact;
  double damping_power = 0;  ///< what materials and the dashpots of contacts and supports dissipate, W/m
  double least_jacobian = 1e300;
  bool sound = true;  ///< false for J <= 0 and lost contacts: a trial step must be rejected
};

/// What an integrator does with new forces while they are in the cache: those of a region, by its index in
/// Model::regions, and of a rigid body. Called by several threads at once. Give it std::cref of closures: copies would
/// be allocated, at every step.
struct PostForceHooks {
  std::function<void(int region)> region;
  std::function<void(int rigid)> rigid;
};

/// All forces on all degrees of freedom for given positions.
class Forces {
 public:
  explicit Forces(const Model& model);

  /// What became of the contact candidates.
  struct Candidates {
    bool found_anew = false;
    bool hold = true;  ///< false for a trial that goes further than the skin at once
  };
  /// Makes sure that the candidates hold for the outlines of a trial that ends at `time`. If they do not, they are
  /// found anew, at the accepted state, whose history is laid out anew and keeps its records: a rejected trial loses
  /// none.
  Candidates ensure_candidates(State& accepted, const OutlineField& trial, double time);

  /// What an evaluation writes.
  struct Output {
    Dofs& force;                  ///< all but drag (bodies/damping_forces.hpp), which is the integrator's
    OutlineField& contact_force;  ///< N/m
    Memory& memory;               ///< that goes with these positions
  };
  /// All forces of a motion, whose outlines these are, from a memory on. `hooks`, if any, follows the forces of
  /// each region and rigid body.
  Evaluation evaluate(const Motion& motion, const Outlines& outlines, const PreviousHistory& from, const Output& to,
                      const PostForceHooks& hooks = {});

  /// What the last trial left behind belongs to this state, if that was it.
  void accept(const State& state) { contact_.accept(state.memory.contact); }

  /// Warns once a run that contacts get deep, after an evaluation that is accepted.
  void warn_of_depth(const Evaluation& evaluation, double time);

  /// As ContactSystem::inherit.
  void inherit(const InheritedContact& from, ContactHistory& history) { contact_.inherit(from, history); }

  const Model& model() const { return model_; }
  const ContactSystem& contact() const { return contact_; }
  PhaseTimes& phases() { return phases_; }

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("contact", contact_);
    visitor("warned_deep", warned_deep_);
  }

 private:
  BatchMotion step_of(const Batch& batch, const Motion& motion, const PreviousHistory& from, Memory& to) const;
  void lane_forces(int b, const Motion& motion, const OutlineField& on_outlines, const PreviousHistory& from,
                   const Output& to);
  void rigid_forces(int r, const Motion& motion, const OutlineField& position, const OutlineField& on_outlines,
                    Dofs& force);
  void spread_forces(const Motion& motion, const OutlineField& on_outlines, const PreviousHistory& from,
                     const Output& to, const PostForceHooks& hooks);

  const Model& model_;
  ContactSystem contact_;
  OutlineField loaded_;                 ///< contact forces and loads on outlines together; empty without such loads
  std::vector<double> least_jacobian_;  ///< [batches of several bodies and chunks of points]
  std::vector<double> damping_power_;   ///< of materials, as least_jacobian_, W/m; empty where none dissipates
  std::vector<std::vector<StressColumns>> stresses_;  ///< [spread bodies][points]
  bool warned_deep_ = false;
  PhaseTimes phases_;
};

}  // namespace pliant
