#pragma once

#include <memory>
#include <variant>

#include "contact/initial_overlap.hpp"
#include "dynamics/energy.hpp"
#include "dynamics/observer.hpp"
#include "dynamics/start_point.hpp"
#include "dynamics/state.hpp"
#include "dynamics/step_doubling.hpp"
#include "dynamics/step_statistics.hpp"
#include "dynamics/verlet.hpp"

namespace pliant {

/// Simulation of a model: state, forces, integrator and energy balance.
class Simulation {
 public:
  /// Starts from the scene's own start, or from the end of another run of the same bodies, at t = 0 in both cases.
  /// Throws ArchiveError for a start point of other bodies.
  explicit Simulation(const Model& model, const StartPoint* start = nullptr);
  StartPoint start_point() const;  ///< from the present state

  /// One accepted step that ends at `until` at the latest. An observer sees its samples within the step. If it is done
  /// then, no step is taken, and the report has dt = 0.
  StepReport step(double until, const Observer* observer = nullptr);
  EnergyBalance energy_balance() {
    forces_.warn_of_missed_contacts(state_);
    return auditor_->audit(state_);
  }
  double energy_gained(const Energies& energy) const { return auditor_->energy_gained(energy); }
  double balance_error(const Energies& energy) const { return auditor_->balance_error(energy); }

  const Model& model() const { return model_; }
  const State& state() const { return state_; }
  const StepControl& control() const { return control_; }
  const Forces& forces() const { return forces_; }
  const InitialOverlap& overlap() const { return overlap_; }
  const StepStatistics& statistics() const { return statistics_; }
  PhaseTimes& phases() { return forces_.phases(); }
  double largest_dt() const;      ///< stability bound, s; infinite for step-doubling
  std::string governing() const;  ///< name of the limiting body

  /// All data on which later steps, energy balances and diagnoses depend: a simulation of the same model that reads
  /// them continues with identical bits.
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("state", state_);
    visitor("control", control_);
    visitor("forces", forces_);
    visitor("auditor", *auditor_);
    visitor("statistics", statistics_);
    std::visit([&](auto& integrator) { visitor("integrator", *integrator); }, integrator_);
  }

 private:
  void begin(const StartPoint& start);

  const Model& model_;
  State state_;
  StepControl control_;
  Forces forces_;
  InitialOverlap overlap_;
  StepStatistics statistics_;
  std::unique_ptr<EnergyAccountant> auditor_;
  std::variant<std::unique_ptr<Verlet>, std::unique_ptr<StepDoubling>> integrator_;
};

}  // namespace pliant
