#include "cli/dry_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "results/probes/probes.hpp"

namespace pliant {
namespace {

constexpr double longest_seconds = 1;
/// The step grows from a thousandth of its bound by at most 15 % a step: after this many it has arrived.
constexpr std::int64_t growth = 150;

double next_multiple(double period, double time) {
  constexpr double rounding = 1e-12;
  return (std::floor(time / period * (1 + rounding)) + 1) * period;
}

double next_output(const Scene& scene, double time) {
  double next = scene.time.end;
  if (scene.frames.period > 0) next = std::min(next, next_multiple(scene.frames.period, time));
  for (const Probe& probe : scene.probes) next = std::min(next, next_multiple(probe.period, time));
  return next;
}

/// The probes of a scene, with nobody to write to.
class ProbeRehearsal {
 public:
  explicit ProbeRehearsal(const Model& model) : model_(model), samplers_(make_samplers(model)) {}
  void take_due(Simulation& simulation) const {
    constexpr double rounding = 1e-9;
    const Snapshot snapshot(simulation);
    for (std::size_t p = 0; p < samplers_.size(); ++p) {
      const double samples = simulation.state().time / model_.scene.probes[p].period;
      if (std::abs(samples - std::round(samples)) < rounding) samplers_[p].sample(snapshot);
    }
  }

 private:
  const Model& model_;
  std::vector<ProbeSampler> samplers_;
};

}  // namespace

DryRun dry_run(Simulation& simulation) {
  using Clock = std::chrono::steady_clock;
  const Scene& scene = simulation.model().scene;
  const State& state = simulation.state();
  const ProbeRehearsal samples(simulation.model());
  const Clock::time_point start = Clock::now();
  const std::int64_t before = state.evaluations;
  double seconds = 0, grown_time = 0;
  std::int64_t grown = 0;
  double next = next_output(scene, state.time);
  bool finished = false;
  const Observer outputs{[&] { return next; },
                         [&] {
                           samples.take_due(simulation);
                           next = next_output(scene, state.time);
                           finished = state.time >= scene.time.end;
                           return !finished;
                         }};
  while (!finished && seconds < longest_seconds) {
    simulation.step(scene.time.stop_at_outputs ? next : std::numeric_limits<double>::infinity(), &outputs);
    if (!finished && outputs.is_due_at(state.time)) outputs.write();
    if (grown == 0 && state.evaluations >= growth) grown = state.evaluations, grown_time = state.time;
    seconds = std::chrono::duration<double>(Clock::now() - start).count();
  }
  DryRun result;
  result.time = state.time;
  result.finished = finished;
  result.evaluations = state.evaluations;
  result.rejections = state.rejections;
  result.seconds_per_evaluation = seconds / static_cast<double>(std::max<std::int64_t>(state.evaluations - before, 1));
  if (grown > 0 && state.evaluations >= grown + growth)
    result.pace = (state.time - grown_time) / static_cast<double>(state.evaluations - grown);
  result.next_dt = simulation.control().next_dt;
  return result;
}

}  // namespace pliant
