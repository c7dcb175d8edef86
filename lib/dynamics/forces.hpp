#pragma once

#include <functional>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "bodies/spread_forces.hpp"
#include "contact/contact.hpp"
#include "dynamics/state.hpp"

namespace pliant {

/// What one force evaluation found.
struct Evaluation {
  PatchTotals contact;
  double damping_power = 0;  ///< what viscosity and the dashpots of contacts and supports dissipate, W/m
  double least_jacobian = 1e300;
  bool refreshed = false;  ///< the contact candidates were rebuilt
  bool sound = true;  ///< false for J <= 0, lost contacts and a motion beyond the skin: a trial step must be rejected
};

/// What an integrator does with the new forces of a region, an index in Model::regions, while they are in the cache. Called by several threads
/// at once.
using RegionWork = std::function<void(int region)>;

/// All forces on all degrees of freedom for given positions.
class Forces {
 public:
  explicit Forces(const Model& model);

  /// Forces of a motion into `force`: all but drag (bodies/damping_forces.hpp), which is the integrator's. `committed` is the contact history to start from, `trial` receives the one that goes
  /// with these positions. `accepted`: the state that a trial step left; candidates are then rebuilt at its positions and its history, laid out
  /// anew, keeps its records, so that a rejected trial loses none. Not sound is then a trial that goes further than the skin at once, and one
  /// that starts from another history than the accepted one: that is void, and no forces are computed. `afterwards`, if any, follows the forces of each region.
  Evaluation evaluate(const Motion& motion, ContactHistory& committed, ContactHistory& trial, Dofs& force,
                      State* accepted = nullptr, const RegionWork& afterwards = {});

  /// Once more at an accepted state. Outlines keep the contact forces of the step that led there: dashpots saw the velocities that it predicted.
  Evaluation evaluate_again(const Motion& motion, ContactHistory& history, ContactHistory& scratch, Dofs& force);

  /// Warns once a run that contacts get deep, after an evaluation that is accepted.
  void warn_of_depth(const Evaluation& evaluation, double time);

  const Model& model() const { return model_; }
  const Outlines& outlines() const { return outlines_; }
  ContactSystem& contact() { return contact_; }
  const ContactSystem& contact() const { return contact_; }
  /// Upper bounds of contact stiffness by outline node, at the current patches: see ContactSystem::stiffness_bound. Seen from where the patches
  /// were found, whatever positions a trial has tried since.
  std::vector<double> stiffness_bound(const std::vector<double>& compliance);

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("outlines", outlines_);
    visitor("contact", contact_);
    visitor("warned_deep", warned_deep_);
  }

 private:
  const Model& model_;
  Outlines outlines_;
  ContactSystem contact_;
  void lane_forces(const Motion& motion, Dofs& force, const RegionWork& afterwards);
  void spread_forces(const Motion& motion, Dofs& force, const RegionWork& afterwards);

  std::vector<double> least_jacobian_;  ///< [batches of several bodies and chunks of points]
  std::vector<double> damping_power_;   ///< of viscosity, as least_jacobian_, W/m; empty without Model::rates
  std::vector<std::vector<StressColumns>> stresses_;  ///< [spread bodies][points]
  bool warned_deep_ = false;
};

}  // namespace pliant
