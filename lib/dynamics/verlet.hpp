#pragma once

#include "dynamics/body_energy_correction.hpp"
#include "dynamics/integrator.hpp"
#include "dynamics/mass_damping.hpp"
#include "dynamics/time_step_bound.hpp"

namespace pliant {

/// Velocity Verlet with a stability bound and an error control without extra cost (docs/method.md 6): one force
/// evaluation per step. It is of second order also with forces that depend on velocities: mass damping
/// (dynamics/mass_damping.hpp) slows the motion by its exact exponential, all others use the velocity that the
/// accelerations so far predict for the end of the step.
class Verlet {
 public:
  Verlet(Forces& forces, const State& state);

  // Called by take_step:
  double first_dt() const;
  Proposal propose(const State& state, double next_dt, double until) const;
  void attempt(State& state, const Proposal& proposal, StepReport& report);
  /// Whether the error of an attempt is acceptable.
  bool within_tolerance(const StepReport& report) const { return report.error <= 2 * model_.scene.time.tolerance; }
  Verdict judge(const State& state, const StepControl& control, const Proposal& proposal,
                const StepReport& report) const;
  void add_damping_work(const State& state, StepReport& report);
  void accepted(State& state, const StepReport& report);
  Trial& trial() { return trial_; }

  // Timed separately by benchmarks:
  const RigidStep* rigid_steps(const State& state);
  void predict(const State& state, double dt);
  void update_region(const State& state, double dt, int r);

  double largest_dt() const { return bound_.largest_dt(); }  ///< s
  std::string governing() const { return bound_.governing(); }
  const TimeStepBound& bound() const { return bound_; }
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("bound", bound_);
  }
  void loaded() { trial_.memory.contact.layout = -1; }  // it belongs to another state

 private:
  Evaluation forces_and_velocities(const State& state, const Motion& motion, double dt);
  void move_by_momenta(const State& state, double dt, double half);
  void predict_velocities(const State& state, double dt);
  void move_by_mean_velocity(const State& state, double dt);
  void update_rigid(const State& state, double dt, int r);
  double error(double dt) const;

  Forces& forces_;
  const Model& model_;
  const bool has_mass_damping_;  ///< some degree of freedom has mass damping
  DampingLoss damping_loss_;
  const bool needs_velocities_;  ///< with mass damping or rates
  TimeStepBound bound_;
  BodyEnergyCorrection body_correction_;
  Trial trial_;
  std::vector<RigidStep> rigid_steps_;
  Dofs mean_velocity_;          ///< of the step, where needed; a reduced momentum, as in a state
  Dofs end_velocity_;           ///< used by forces at the end of the step, where needed
  Dofs moving_velocity_;        ///< scratch: of reduced momenta, with a reciprocal mass
  std::vector<double> change_;  ///< [regions, rigid bodies] change of the acceleration over the nodal distance, 1/s2
};

}  // namespace pliant
