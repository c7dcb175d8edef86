#pragma once

#include <functional>
#include <string>

#include "reference/cell_motion.hpp"
#include "reference/newton.hpp"
#include "reference/system.hpp"

namespace pliant::reference {

struct SolverOptions {
  bool statics = false;  ///< equilibrium at each time, without inertia
  MassMatrix mass = MassMatrix::lumped;
  double dt = 0;   ///< s
  double hht = 0;  ///< alpha of Hilber, Hughes and Taylor, in [-1/3, 0]; 0: Newmark's average acceleration
  /// Static runs: initial pseudo-inertia as a share of the largest stiffness, for pseudo-transient continuation where
  /// Newton's method fails; 0: never.
  double pseudo_inertia = 1e-3;
  NewtonOptions newton;
};

/// Energy balance of a run, J/m, as in the engine (docs/method.md 6).
struct EnergyBalance {
  double kinetic = 0, strain = 0, contact = 0, boundary = 0;
  double dissipated_by_contact = 0, dissipated_by_damping = 0, dissipated_by_plasticity = 0, dissipated_by_bonds = 0;
  double work_of_loads = 0, work_of_gravity = 0;
  double at_start = 0;  ///< kinetic, strain, contact and boundary energy

  double mechanical() const { return kinetic + strain + contact + boundary; }
  double dissipated() const {
    return dissipated_by_contact + dissipated_by_damping + dissipated_by_plasticity + dissipated_by_bonds;
  }
  double external_work() const { return work_of_loads + work_of_gravity; }
  double made() const;           ///< energy without a source; negative: lost, J/m
  double scale() const;          ///< largest of external work, initial energy and dissipation, J/m
  double balance_error() const;  ///< |made| over scale
};

/// Report of one requested step.
struct StepRecord {
  double dt = 0;       ///< of the shortest substep, s
  int iterations = 0;  ///< of all substeps
  int bisections = 0;
  double residual = 0;            ///< the last one, relative
  std::vector<double> residuals;  ///< of the last substep's iterations
  std::string trouble;            ///< of the last substep that did not converge
};

/// Time integration of a scene (docs/design.md 6).
class TimeStepping {
 public:
  TimeStepping(System& system, const SolverOptions& options);

  /// Advances to a later time, with a step to each point of a history, each end of a window and each time when bonds
  /// are made before it; halves steps that do not converge. Throws PhysicsError with the worst body, the residual and
  /// the last valid time if even a thousandth of the step does not converge.
  StepRecord step(double until);

  const Motion& motion() const { return motion_; }
  const Forces& forces() const { return forces_; }  ///< at the present motion
  const Vector& acceleration() const { return acceleration_; }
  const SparseMatrix& mass() const { return mass_; }
  const EnergyBalance& balance() const { return balance_; }
  bool is_static() const { return options_.statics; }
  /// Velocity gradient of a cell, 1/s; 0 in static runs.
  Eigen::Matrix2d cell_flow() const { return velocity_gradient(system_.bodies().scene(), motion_.time, cell_rate_); }
  const LinearSolver::Counts& solver_counts() const { return solver_.counts(); }

 private:
  struct Trial;
  void step(double until, int depth, StepRecord& record);
  bool try_step(double until, Trial& trial, StepRecord& record);
  void accept(const Trial& trial);
  void update_balance(const Trial& trial);
  void pass_switch();
  void turn_cell();
  Forces evaluate(const Motion& motion, bool tangent);
  Vector predicted(double dt) const;
  Motion motion_at(double until, const Vector& ahead) const;
  Vector acceleration_at(double dt, const Vector& ahead) const { return ahead / (beta_ * dt * dt); }
  Linearisation equations(double until, const SparseMatrix& select, const Vector& ahead, bool tangent, Trial& trial);
  bool note(const NewtonResult& result, StepRecord& record) const;
  bool moves_too_far(const Vector& q, const CellMotion& cell, StepRecord& record) const;
  double largest_motion(const Vector& next, const CellMotion& cell) const;
  double work_on_images(const Trial& trial) const;
  void find_acceleration();
  std::vector<int> free_dofs(double time) const;

  System& system_;
  SolverOptions options_;
  double beta_, gamma_;
  SparseMatrix mass_;
  std::vector<double> switch_times_;
  std::vector<int> held_;  ///< static runs: degrees of freedom that hold the grains of a cell in place
  Vector holding_;         ///< static runs: [dofs], masses scaled to the largest stiffness, N/m2 (N)
  Vector arms_;            ///< static runs: [dofs], displacement of the outline per unit, 1 or m
  LinearSolver solver_;
  Motion motion_;
  Eigen::Matrix2d cell_rate_ = Eigen::Matrix2d::Zero();  ///< of the deformation gradient of a cell, 1/s
  Vector acceleration_;
  Forces forces_;
  EnergyBalance balance_;
  std::string worst_;  ///< body with the largest residual of the last evaluation
};

}  // namespace pliant::reference
