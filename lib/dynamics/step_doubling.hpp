#pragma once

#include <limits>

#include "dynamics/integrator.hpp"
#include "dynamics/mass_damping.hpp"

namespace pliant {

/// The paper's scheme (docs/method.md 6): semi-implicit Euler once with dt (u1) and twice with dt/2 (u2, kept),
/// controlled by err = max |u2 - u1| / d over all field nodes and rigid outline nodes. It takes two force evaluations
/// per step and has no stability bound. Loads act with their mean over each half step; forces that depend on velocities
/// use those at its start.
class StepDoubling {
 public:
  StepDoubling(Forces& forces, const State& state);

  // Called by take_step:
  double first_dt() const;
  Proposal propose(const State& state, double next_dt, double until) const;
  void attempt(State& state, const Proposal& proposal, StepReport& report);
  /// Whether the error of an attempt is acceptable.
  bool within_tolerance(const StepReport& report) const {
    return report.error <= model_.scene.time.alpha * model_.scene.time.target;
  }
  Verdict judge(const State& state, const StepControl& control, const Proposal& proposal,
                const StepReport& report) const;
  void add_damping_work(const State&, const StepReport&) {}
  void accepted(const State&, const StepReport&) {}
  Trial& trial() { return trial_; }

  double largest_dt() const { return std::numeric_limits<double>::infinity(); }  ///< s
  std::string governing() const { return "error control"; }
  template <class Visitor>
  void visit(Visitor&&) {}                                                            ///< nothing is kept between steps
  void loaded() { trial_.memory.contact.layout = half_memory_.contact.layout = -1; }  // these belong to another state

 private:
  /// `voided`: contact candidates were rebuilt in the second half, and its history does not belong to them.
  enum class Halves { done, failed, voided };
  Halves try_halves(State& state, const Proposal& proposal, StepReport& report);
  void find_start_force(const State& state, double half);
  Motion motion(const Instant& at) const;
  Forces::ListCheck show(State& state, const Instant& at, const Proposal& proposal, StepReport& report);
  bool evaluate(const Instant& at, const PreviousHistory& from, Memory& to, StepReport& report);
  void half_step(const Dofs& position, const Dofs& velocity, const Dofs& force, double time, double half);
  double error(const State& state, double dt);
  void find_difference(const Region& region, double dt);
  void apply_reciprocal_mass_to_difference();
  double region_error(const Region& region) const;
  double rigid_error(std::size_t rigid, const State& state, double dt) const;

  Forces& forces_;
  const Model& model_;
  const bool has_mass_damping_;  ///< some degree of freedom has mass damping
  DampingLoss damping_loss_;
  double wave_time_;                       ///< time of a wave between nodes, s
  Dofs moving_velocity_;                   ///< scratch with a reciprocal mass: C y
  Dofs start_force_;                       ///< for the first half step
  Trial trial_;                            ///< at the half step, then at the end
  Memory half_memory_;                     ///< at the half step
  OutlineField half_outlines_;             ///< likewise
  std::vector<Lanes> difference_;          ///< u2 - u1 of the compliant degrees of freedom
  std::vector<Lanes> reduced_difference_;  ///< scratch: difference before C
};

}  // namespace pliant
