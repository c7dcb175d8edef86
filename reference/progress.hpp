#pragma once

#include <chrono>
#include <string>

#include "reference/time_stepping.hpp"

namespace pliant::reference {

/// Solver counters of a run so far.
struct Effort {
  long steps = 0, bisections = 0, iterations = 0;
};

/// Reports the progress of a run on the standard error: a line redrawn every second on a terminal, a line every ten
/// seconds otherwise, or one per step.
class Progress {
 public:
  enum class Detail { none, periodic, steps };
  Progress(Detail detail, double end);
  /// Cheap if no line is due.
  void show_if_due(const TimeStepping& run, const StepRecord& last, const Effort& effort);
  void say(const std::string& line);  ///< before the first step; nothing if empty
  void finish();                      ///< ends the line, so that further output can follow
  double seconds() const;             ///< since construction

 private:
  using Clock = std::chrono::steady_clock;
  Detail detail_;
  double end_;  ///< of the scene, s
  bool terminal_, open_ = false;
  Clock::time_point start_, last_;
};

/// Least Jacobian of compliant bodies; 1 without any.
double least_jacobian(const Forces& forces);

}  // namespace pliant::reference
