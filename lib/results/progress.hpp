#pragma once

#include <chrono>
#include <cstdint>

#include "dynamics/simulation.hpp"

namespace pliant {

/// The line that says how a run is doing: time, dt and what governs it, evaluations per second, energy balance, time
/// left. Redrawn every second on a terminal, a line every ten seconds otherwise.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  /// The state that this process starts from, for speeds and time left. A run's first line: bodies that overlap.
  void begin(const Simulation& simulation);
  /// Cheap when no line is due. Returns the audit it took, if any, through `audit`.
  bool show_if_due(Simulation& simulation, const StepReport& report, EnergyBalance& audit);
  void finish() const;
  double seconds() const;  ///< since construction

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, terminal_;
  Clock::time_point start_, last_;
  double start_time_ = 0;  ///< of the scene, s
  std::int64_t last_evaluations_ = 0;
};

}  // namespace pliant
