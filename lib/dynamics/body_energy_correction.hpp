#pragma once

#include <vector>

#include "dynamics/trial.hpp"

namespace pliant {

/// Steps between corrections: each evaluates all strain energies, and costs as much as a step's internal forces.
constexpr int correction_period = 200;
/// Share of the energy error that one correction removes. The error fluctuates with the forces, so about ten
/// corrections average it.
constexpr double corrected_share = 0.1;
/// Largest relative change of velocities by one correction: 1e-5 a step. The errors of vibrating bodies are a hundredth
/// of that (verify/undamped), those of a bouncing disc about a tenth.
constexpr double largest_correction_of_bodies = 1e-5 * correction_period;
/// Largest energy error over the kinetic energy of vibrations. A larger error waits, as its correction would shake a
/// body that is nearly at rest.
constexpr double largest_error_of_bodies = 1;

/// Energy correction of undamped compliant bodies (docs/method.md 6). Equal steps of velocity Verlet keep
/// K + U - dt^2 sum F^2/(8 m) + (dt^2 sum F F_before/m - sum dx dF)/12, with dx and dF of a step, up to third powers of
/// the step; if forces are linear, up to rounding. Contacts correct the energy that they gain or lose
/// (contact/energy_correction.hpp), and so keep energy that stresses would have returned to them: vibrating bodies gain
/// energy. They also do when the step size changes. The energy error of a body, J/m, is its energy beyond its start and
/// the work of contacts and gravity. The correction scales the velocities relative to the rigid motion slightly;
/// momentum and angular momentum do not change.
class BodyEnergyCorrection {
 public:
  explicit BodyEnergyCorrection(const Model& model);
  /// Whether some body is corrected: compliant, without damping, internal variables, loads or supports, in a scene with
  /// energy correction of contacts.
  bool is_active() const { return !corrected_.empty(); }

  /// Adds the work of contacts in an accepted step; `before`: the state before it.
  void add_work(const Trial& before, State& state) const;
  /// Scales velocities, every correction_period steps; dt: of the step that led here. The first call sets the energies
  /// at the start of the balance, because steps are short before.
  void correct(const Trial& before, State& state, double dt) const;
  /// Energy errors of the bodies of a batch after a step, once the balance has started, J/m.
  Lanes error(const Trial& before, const State& state, int batch, double dt) const;

 private:
  Lanes energy(const Trial& before, const State& state, int batch, double dt) const;

  const Model& model_;
  /// [batches] 1, or 0 for bodies without correction and padding; empty: no body has it
  std::vector<Lanes> corrected_;
  std::vector<int> bodies_;  ///< own bodies that are corrected
};

}  // namespace pliant
