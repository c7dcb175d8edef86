#pragma once

#include <functional>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "contact/contact.hpp"
#include "dynamics/state.hpp"

namespace pliant {

/// What one force evaluation found.
struct Evaluation {
  PatchTotals contact;
  double damping_power = 0;  ///< what forces that depend on velocities dissipate, W/m
  double least_jacobian = 1e300;
  bool refreshed = false;  ///< the contact candidates were rebuilt
  bool sound = true;  ///< false for J <= 0, lost contacts and a motion beyond the skin: a trial step must be rejected
};

/// What an integrator does with the new forces of batch b, an index in Model::batches, while they are in the cache. Called by several threads at once.
using BatchWork = std::function<void(int b)>;

/// All forces on all degrees of freedom for given positions.
class Forces {
 public:
  explicit Forces(const Model& model);

  /// Total forces of a motion into `force`. `committed` is the contact history to start from, `trial` receives the one that goes
  /// with these positions. `accepted`: the state that a trial step left; candidates are then rebuilt at its positions and its history, laid out
  /// anew, keeps its records, so that a rejected trial loses none. Not sound is then a trial that goes further than the skin at once, and one
  /// that starts from another history than the accepted one: that is void, and no forces are computed. `afterwards`, if any, follows the forces of each batch.
  Evaluation evaluate(const Motion& motion, ContactHistory& committed, ContactHistory& trial, Dofs& force,
                      State* accepted = nullptr, const BatchWork& afterwards = {});

  /// Warns once a run that contacts get deep, after an evaluation that is accepted.
  void warn_of_depth(const Evaluation& evaluation, double time);

  const Model& model() const { return model_; }
  const Outlines& outlines() const { return outlines_; }
  ContactSystem& contact() { return contact_; }
  const ContactSystem& contact() const { return contact_; }
  /// Upper bounds of contact stiffness by outline node, at the current patches: see ContactSystem::stiffness_bound. Seen from where the patches
  /// were found, whatever positions a trial has tried since.
  std::vector<double> stiffness_bound(const std::vector<double>& compliance);

 private:
  const Model& model_;
  Outlines outlines_;
  ContactSystem contact_;
  std::vector<double> least_jacobian_;  ///< [batches]
  bool warned_deep_ = false;
};

}  // namespace pliant
