#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

namespace pliant {

enum class Phase {
  outlines,    ///< positions of outline nodes
  candidates,  ///< checks of contact candidates, and their rebuild
  contact,     ///< contact forces
  internal,    ///< internal and other forces; new velocities of verlet, which follow body by body
  update,      ///< motion, error, energy balance
  bound,       ///< bound of the stable step
  output,
};
constexpr std::array phase_names{"outlines", "candidates", "contact", "internal", "update", "bound", "output"};

/// Wall time of a run by phases. Phases of every step are timed in one step of 16, so that the clock costs no scene as
/// much as 0.5 %; rare work is timed separately, each time.
template <class Clock>
class PhaseTimesBy {
 public:
  static constexpr int period = 16;
  using Seconds = std::array<double, phase_names.size()>;

  /// Begins a step, with its update; the time since the previous step was output.
  void begin_step(std::int64_t step) {
    enter(Phase::output);
    sampling_ = step % period == 0;
    if (sampling_) since_ = Clock::now(), phase_ = Phase::update;
  }
  void end_step() { enter(Phase::output); }
  /// Within a step: ends the present phase and begins another.
  void enter(Phase phase) {
    if (!sampling_) return;
    const auto now = Clock::now();
    sampled_[index(phase_)] += now - since_;
    since_ = now, phase_ = phase;
  }
  /// Runs and times `action`, which is rare and does not belong to the current phase.
  template <class Action>
  void apart(Phase phase, Action&& action) {
    if (apart_) return action();
    const bool sampling = std::exchange(sampling_, false);
    const auto start = Clock::now();
    apart_ = true;
    action();
    apart_ = false;
    const auto taken = Clock::now() - start;
    measured_[index(phase)] += taken;
    since_ += taken, sampling_ = sampling;
  }

  /// Seconds of each phase, which add up to `wall`, the wall time of the run. Time that was not measured separately is
  /// divided in the ratio of the samples. Without any sample it is output.
  Seconds seconds(double wall) const {
    Seconds result{};
    double rest = wall;
    for (std::size_t p = 0; p < result.size(); ++p) result[p] = in_seconds(measured_[p]), rest -= result[p];
    const double samples = in_seconds(std::accumulate(sampled_.begin(), sampled_.end(), Duration{}));
    if (samples > 0)
      for (std::size_t p = 0; p < result.size(); ++p) result[p] += rest * (in_seconds(sampled_[p]) / samples);
    else
      result[index(Phase::output)] += rest;
    return result;
  }

 private:
  using Duration = typename Clock::duration;
  static std::size_t index(Phase phase) { return static_cast<std::size_t>(phase); }
  static double in_seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

  std::array<Duration, phase_names.size()> sampled_{}, measured_{};
  typename Clock::time_point since_{};
  Phase phase_ = Phase::output;
  bool sampling_ = false, apart_ = false;
};

using PhaseTimes = PhaseTimesBy<std::chrono::steady_clock>;

}  // namespace pliant
