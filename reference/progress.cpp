#include "reference/progress.hpp"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

namespace pliant::reference {

double least_jacobian(const Forces& forces) { return forces.worst_body < 0 ? 1.0 : forces.least_jacobian; }

Progress::Progress(Detail detail, double end)
    : detail_(detail), end_(end), terminal_(isatty(STDERR_FILENO) != 0), start_(Clock::now()), last_(start_) {}

double Progress::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::show_if_due(const TimeStepping& run, const StepRecord& last, const Effort& effort) {
  const Clock::time_point now = Clock::now();
  const bool each = detail_ == Detail::steps;
  const double since = std::chrono::duration<double>(now - last_).count();
  if (detail_ == Detail::none || (!each && since < (terminal_ ? 1.0 : 10.0))) return;
  last_ = now;
  const double time = run.motion().time;
  const std::string line = fmt::format(
      "t = {:.4g} of {:.4g} s | dt {:.3g} s | Newton iterations {}, residual {:.1e} | least J {:.4f} | balance {:.1e} "
      "| "
      "{} steps, {} halved | {:.0f} s left",
      time, end_, last.dt, last.iterations, last.residual, least_jacobian(run.forces()), run.balance().balance_error(),
      effort.steps, effort.bisections, seconds() * (end_ - time) / time);
  open_ = terminal_ && !each;
  std::fprintf(stderr, open_ ? "\r\033[K%s" : "%s\n", line.c_str());
  std::fflush(stderr);
}

void Progress::say(const std::string& line) {
  if (detail_ != Detail::none && !line.empty()) fmt::print(stderr, "{}\n", line);
}

void Progress::finish() {
  if (open_) std::fputc('\n', stderr);
  open_ = false;
}

}  // namespace pliant::reference
