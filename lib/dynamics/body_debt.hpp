#pragma once

#include <vector>

#include "dynamics/trial.hpp"

namespace pliant {

/// Steps between settlements: each looks at all strain energies, and costs a step's internal forces.
constexpr int settling_period = 200;
/// Of a debt, what a settlement takes back or gives: what is owed flickers with the forces, so ten make a mean.
constexpr double settled_share = 0.1;
/// Of velocities, most that a settlement changes: a millionth a step. Bodies that ring need a tenth of that
/// (verify/undamped). What is owed beyond waits: by bodies that all but stand still, and by ones that bounce for good.
constexpr double most_settled = 1e-6 * settling_period;

/// Undamped compliant bodies that keep their energy (docs/method.md 6). In equal steps of velocity Verlet
/// K - dt^2 sum F^2/(8 m) grows by the work of the mean of the forces at a step's ends. The work of all of them makes
/// up for what energies store but for terms of the moment. Contacts repay what they make or lose
/// (contact/energy_debt.hpp), and so leave what stresses would have given back to them: bodies that ring heat. So they
/// do where steps change. What a body has beyond its start and what contacts and gravity did to it is its debt,
/// J/m. It repays by velocities: those relative to its rigid motion are scaled by a little, which leaves momentum and
/// angular momentum as they are.
class BodyDebts {
 public:
  explicit BodyDebts(const Model& model);
  /// Whether some body has debts: compliant, without damping, memory, loads or supports, where contacts repay.
  bool are_kept() const { return !repays_.empty(); }

  /// Books what contacts did in an accepted step; `before`: what the state was then.
  void book(const Trial& before, State& state) const;
  /// Scales velocities, every settling_period steps; dt: of the step that led here. The first time opens the books:
  /// steps are short before.
  void settle(State& state, double dt) const;
  /// Of the bodies of a batch, while books are open, J/m.
  Lanes owed(const State& state, int batch, double dt) const;

 private:
  Lanes energy(const State& state, int batch, double dt) const;

  const Model& model_;
  std::vector<Lanes> repays_;  ///< [batches] 1, or 0 for bodies that keep no debts and padding; empty: none does
};

}  // namespace pliant
