#pragma once

#include <chrono>
#include <string>

#include "reference/time_stepping.hpp"

namespace pliant::reference {

/// What a run has cost so far.
struct Effort {
  long steps = 0, bisections = 0, iterations = 0;
};

/// Says on the standard error how a run is doing: a line redrawn every second on a terminal, a line every ten seconds
/// otherwise, or one a step.
class Progress {
 public:
  enum class Detail { none, periodic, steps };
  Progress(Detail detail, double end);
  /// Cheap when no line is due.
  void show_if_due(const TimeStepping& run, const StepRecord& last, const Effort& effort);
  void say(const std::string& line);  ///< before the first step; nothing when empty
  void finish();                      ///< leaves the line as it is, for what is printed next
  double seconds() const;             ///< since construction

 private:
  using Clock = std::chrono::steady_clock;
  Detail detail_;
  double end_;  ///< of the scene, s
  bool terminal_, open_ = false;
  Clock::time_point start_, last_;
};

/// Of compliant bodies; 1 without any.
double least_jacobian(const Forces& forces);

}  // namespace pliant::reference
