#include "results/progress.hpp"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

namespace pliant {

ProgressLine::ProgressLine(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), start_(Clock::now()), last_(start_) {}

double ProgressLine::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void ProgressLine::begin(const Simulation& simulation) {
  const State& state = simulation.state();
  start_time_ = state.time;
  last_evaluations_ = state.evaluations;
  if (!quiet_ && state.steps == 0 && simulation.overlap().pairs > 0)
    fmt::print(stderr, "overlap at the start: {}\n", describe(simulation.overlap(), simulation.model()));
}

bool ProgressLine::show_if_due(Simulation& simulation, const StepReport& report, EnergyBalance& audit) {
  const Clock::time_point now = Clock::now();
  const double since = std::chrono::duration<double>(now - last_).count();
  if (since < (terminal_ ? 1.0 : 10.0)) return false;
  const State& state = simulation.state();
  audit = simulation.energy_balance();
  const double rate = static_cast<double>(state.evaluations - last_evaluations_) / since;
  const double done = state.time - start_time_, to_do = simulation.model().scene.time.end - state.time;
  const double left = done > 0 ? seconds() * to_do / done : 0;
  if (!quiet_) {
    const std::string line = fmt::format(
        "t = {:.4g} of {:.4g} s | dt {:.3g} s ({}{}) | {:.0f} evaluations/s | balance {:.2e} | {:.0f} s left",
        state.time, simulation.model().scene.time.end, report.dt, name_of(report.limited_by),
        report.limited_by == StepLimit::stability ? ": " + simulation.governing() : "", rate,
        simulation.balance_error(audit.energy), left);
    std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", line.c_str());
    std::fflush(stderr);
  }
  last_ = now;
  last_evaluations_ = state.evaluations;
  return true;
}

void ProgressLine::finish() const {
  if (!quiet_ && terminal_) std::fputc('\n', stderr);
}

}  // namespace pliant
