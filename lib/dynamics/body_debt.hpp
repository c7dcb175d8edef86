#pragma once

#include <vector>

#include "dynamics/trial.hpp"

namespace pliant {

/// Steps between settlements: each looks at all strain energies, and costs a step's internal forces.
constexpr int settling_period = 200;
/// Of a debt, what a settlement takes back or gives: what is owed flickers with the forces, so ten make a mean.
constexpr double settled_share = 0.1;
/// Of velocities, most that a settlement changes: 1e-5 a step. What is made in bodies that ring is a hundredth of that
/// (verify/undamped), in a disc that bounces a tenth or so.
constexpr double most_settled = 1e-5 * settling_period;
/// Over the kinetic energy of vibrations: beyond, a debt waits, lest a loud past shake what all but stands still.
constexpr double most_owed = 1;

/// Undamped compliant bodies that keep their energy (docs/method.md 6). Equal steps of velocity Verlet, for themselves,
/// keep K + U - dt^2 sum F^2/(8 m) + (dt^2 sum F F_before/m - sum dx dF)/12, dx and dF of a step, but for third powers
/// of the step; where forces are linear, to rounding. Contacts repay what they make or lose (contact/energy_debt.hpp),
/// and so leave what stresses would have given back to them: bodies that ring heat; so they do where steps change. What
/// a body has beyond its start and what contacts and gravity did to it is its debt, J/m. It repays by velocities: those
/// relative to its rigid motion are scaled by a little, which leaves momentum and angular momentum as they are.
class BodyDebts {
 public:
  explicit BodyDebts(const Model& model);
  /// Whether some body has debts: compliant, without damping, memory, loads or supports, where contacts repay.
  bool are_kept() const { return !repays_.empty(); }

  /// Books what contacts did in an accepted step; `before`: what the state was then.
  void book(const Trial& before, State& state) const;
  /// Scales velocities, every settling_period steps; dt: of the step that led here. The first time opens the books:
  /// steps are short before.
  void settle(const Trial& before, State& state, double dt) const;
  /// Of the bodies of a batch after a step, while books are open, J/m.
  Lanes owed(const Trial& before, const State& state, int batch, double dt) const;

 private:
  Lanes energy(const Trial& before, const State& state, int batch, double dt) const;

  const Model& model_;
  std::vector<Lanes> repays_;  ///< [batches] 1, or 0 for bodies that keep no debts and padding; empty: none does
};

}  // namespace pliant
