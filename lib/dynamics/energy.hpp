#pragma once

#include "bodies/model.hpp"
#include "dynamics/state.hpp"

namespace pliant {

/// Energies of a state, J per metre of thickness.
struct Energies {
  double kinetic = 0, strain = 0;
  double contact = 0;        ///< stored in contacts; negative where cohesive surfaces are joined
  double boundary = 0;       ///< in the springs of soft supports
  double dissipated = 0;     ///< by slip, dashpots and viscosity, summed from the laws' own work
  double external_work = 0;  ///< of loads, imposed motions and gravity
  double mechanical() const { return kinetic + strain + contact + boundary; }
};

/// `velocity` as a state holds it: see bodies/reciprocal_mass.hpp.
double kinetic_energy(const Model& model, const Dofs& velocity);

/// Sums and checks of one state: energies, and residuals of the balances of momentum.
struct EnergyBalance {
  Energies energy;
  /// |sum of contact forces|, of their moments, and of each body's internal forces, over the sums of magnitudes.
  double momentum_error = 0;
  int contacts = 0;
};

/// Energy balance of a run from a given start.
class EnergyAccountant {
 public:
  /// `start` must hold forces of its own positions, as after the first evaluation.
  EnergyAccountant(const Model& model, const State& start);
  EnergyBalance audit(const State& state);

  /// Mechanical energy that neither the start nor work nor dissipation accounts for, J/m; negative if some is lost.
  double energy_gained(const Energies& energy) const;
  /// |energy_gained| over the largest of external work, initial mechanical energy and dissipation; 0 when all vanish.
  double balance_error(const Energies& energy) const;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("gravity_start", gravity_start_);
    visitor("energy_start", energy_start_);
    visitor("warned_of_strain", warned_of_strain_);
  }

 private:
  void warn_of_strain(const State& state);
  double constant_gravity_moment(const Dofs& position) const;
  double internal_imbalance(const State& state) const;
  double contact_imbalance(const State& state) const;

  const Model& model_;
  double gravity_start_ = 0;
  double energy_start_ = 0;
  bool warned_of_strain_ = false;
};

}  // namespace pliant
