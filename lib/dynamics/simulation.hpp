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

/// A model in motion: state, forces, integrator and energy books.
class Simulation {
 public:
  /// From the scene's own start, or from where another run of the same bodies ended, at t = 0 either way. Throws
  /// ArchiveError for a start point of other bodies.
  explicit Simulation(const Model& model, const StartPoint* start = nullptr);
  StartPoint start_point() const;  ///< of the state now

  /// One accepted step, ending at `until` at the latest. An observer sees what it passes by; if it has seen enough
  /// then, no step is taken, and the report's has no length.
  StepReport step(double until, const Observer* observer = nullptr);
  EnergyBalance energy_balance() { return auditor_->audit(state_); }
  double energy_gained(const Energies& energy) const { return auditor_->energy_gained(energy); }
  double balance_error(const Energies& energy) const { return auditor_->balance_error(energy); }

  const Model& model() const { return model_; }
  const State& state() const { return state_; }
  const Forces& forces() const { return forces_; }
  const InitialOverlap& overlap() const { return overlap_; }
  const StepStatistics& statistics() const { return statistics_; }
  PhaseTimes& phases() { return forces_.phases(); }
  double largest_dt() const;      ///< stability bound, s; infinite for step-doubling
  std::string governing() const;  ///< what limits the stability bound

  /// Everything that the coming steps, audits and diagnoses depend on: a simulation of the same model that reads it
  /// goes on with the same bits.
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("state", state_);
    forces_.accept(state_);
    visitor("forces", forces_);
    visitor("auditor", *auditor_);
    visitor("statistics", statistics_);
    std::visit([&](auto& integrator) { visitor("integrator", *integrator); }, integrator_);
  }

 private:
  void begin(const StartPoint& start);

  const Model& model_;
  State state_;
  Forces forces_;
  InitialOverlap overlap_;
  StepStatistics statistics_;
  std::unique_ptr<EnergyAccountant> auditor_;
  std::variant<std::unique_ptr<Verlet>, std::unique_ptr<StepDoubling>> integrator_;
};

}  // namespace pliant
