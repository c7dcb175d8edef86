#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "contact/contact.hpp"

namespace pliant {

/// What one force evaluation found.
struct Evaluation {
  PatchTotals contact;
  double least_jacobian = 1e300;
  bool refreshed = false;  ///< the contact candidates were rebuilt
  bool sound = true;  ///< false for J <= 0, lost contacts and a motion beyond the skin: a trial step must be rejected
};

/// All forces on all degrees of freedom for given positions.
class Forces {
 public:
  explicit Forces(const Model& model);

  /// Total forces at `position` and `time` into `force`. `committed` is the contact history of the last accepted step (laid out anew by a
  /// refresh), `trial` receives the one that goes with these positions. `accepted`: positions of that step, when these are on trial; candidates are
  /// then rebuilt there, so that a rejected trial loses no record, and a trial that goes further than the skin at once is not sound.
  Evaluation evaluate(const Dofs& position, double time, ContactHistory& committed, ContactHistory& trial, Dofs& force,
                      const Dofs* accepted = nullptr);

  /// For positions that are meant to stay, right after their evaluation: throws PhysicsError when it is not sound, warns of deep contacts.
  void check(const Evaluation& evaluation, double time);

  const Model& model() const { return model_; }
  const Outlines& outlines() const { return outlines_; }
  ContactSystem& contact() { return contact_; }
  const ContactSystem& contact() const { return contact_; }
  /// Upper bounds of contact stiffness by outline node, at the current patches: see ContactSystem::stiffness_bound.
  std::vector<double> stiffness_bound(const std::vector<double>& compliance) {
    return contact_.stiffness_bound(outlines_, compliance);
  }

 private:
  const Model& model_;
  Outlines outlines_;
  ContactSystem contact_;
  std::vector<double> least_jacobian_;  ///< [batches]
  bool warned_deep_ = false;
};

}  // namespace pliant
