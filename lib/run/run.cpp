#include "run/run.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "bodies/short_edges.hpp"
#include "core/errors.hpp"
#include "core/stop_signals.hpp"
#include "core/warnings.hpp"
#include "files/atomic_file.hpp"
#include "files/folder_lock.hpp"
#include "files/output_folder.hpp"
#include "input/read_scene.hpp"
#include "input/scene_difference.hpp"
#include "results/recorder.hpp"
#include "results/scene_files.hpp"
#include "run/balance_warning.hpp"
#include "run/checkpoint.hpp"
#include "run/default_threads.hpp"
#include "run/failure_report.hpp"
#include "run/fold_warning.hpp"
#include "run/start_file.hpp"
#include "scene/line_reader.hpp"
#include "setup/build_model.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

fs::path failure_file(const fs::path& folder) { return folder / "failure.json"; }

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Such as "contact 41 %, internal 39 %": what takes most comes first, without what takes less than half a percent.
std::string shares(const PhaseTimes::Seconds& seconds) {
  const double all = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  std::vector<std::pair<double, const char*>> phases;
  for (std::size_t p = 0; p < seconds.size(); ++p)
    if (seconds[p] >= 0.005 * all) phases.emplace_back(100 * seconds[p] / all, phase_names[p]);
  std::sort(phases.begin(), phases.end(), std::greater<>());
  std::vector<std::string> texts;
  for (const auto& [percent, name] : phases) texts.push_back(fmt::format("{} {:.0f} %", name, percent));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// What is said of a run that has come to its end.
std::string last_line(Simulation& simulation, const RunFigures& figures, const RunOptions& options) {
  const State& state = simulation.state();
  const EnergyBalance audit = simulation.energy_balance();
  return fmt::format(
      "{}: t = {:.6g} s in {:.1f} s, {} steps, {} rejected, {} evaluations ({:.0f}/s), energy balance {:.2e}, momentum "
      "{:.1e}; time: {}\n",
      options.out.string(), state.time, figures.wall_seconds, state.steps, state.rejections, state.evaluations,
      static_cast<double>(state.evaluations) / figures.wall_seconds, simulation.balance_error(audit.energy),
      std::max(audit.momentum_error, figures.worst_momentum_error),
      shares(simulation.phases().seconds(figures.process_seconds)));
}

/// A run under way: its simulation, its outputs and its checkpoints.
struct Run {
  const RunOptions& options;
  const std::string& scene_text;
  Simulation& simulation;
  Recorder& recorder;
  Clock::time_point last_checkpoint = Clock::now();
  std::string end_summary = {}, end_line = {};    ///< once the end was seen
  std::size_t warned = warnings_so_far().size();  ///< of these none is of a step that is not noted yet

  /// Keeps the warnings of the steps since the last call for the processes that go on.
  void note_warnings() {
    for (; warned < warnings_so_far().size(); ++warned) recorder.figures.warnings.push_back(warnings_so_far()[warned]);
  }
  /// Warns of bodies that have folded through themselves by now. Returns whether there are any.
  bool warn_of_folds() const {
    const std::vector<Fold> folds = find_folds(simulation.model(), simulation.state().outlines.position);
    if (!folds.empty()) spdlog::warn("{}", fold_warning(simulation.model(), folds, simulation.state().time));
    return !folds.empty();
  }
  /// Outputs that are due. Each frame is searched for folds until one has a fold.
  void write_outputs() {
    if (recorder.record_outputs(simulation) && !recorder.figures.warned_of_folds)
      recorder.figures.warned_of_folds = warn_of_folds();
  }
  void write_checkpoint(const std::string& status) {
    note_warnings();
    simulation.phases().apart(Phase::output, [&] {
      pliant::write_checkpoint(options.out, scene_text, simulation, recorder, simulation.state().time);
      recorder.write_summary(simulation, status);
    });
    last_checkpoint = Clock::now();
  }

  bool has_ended() const { return !end_summary.empty(); }
  /// At the end, where the state is one to look at: to a later end the run goes on from before it, as if it were none.
  void see_end() {
    recorder.finish_progress();
    const Energies energy = simulation.energy_balance().energy;
    note_warnings();
    if (!recorder.figures.warned_of_folds) warn_of_folds();
    warn_of_balance(simulation, energy);
    warned = warnings_so_far().size();
    const double before = std::exchange(recorder.figures.checkpoint_time, simulation.state().time);
    end_summary = recorder.summary(simulation, "finished");
    recorder.figures.checkpoint_time = before;
    write_start_file(options.out, scene_text, simulation);
    end_line = last_line(simulation, recorder.figures, options);
  }
  void write_end() {
    pliant::write_checkpoint(options.out, scene_text, simulation, recorder, simulation.model().scene.time.end);
    recorder.write_summary(end_summary);
  }

  bool checkpoint_due() const {
    const std::optional<double> period = simulation.model().scene.checkpoint_period;
    return period && seconds_since(last_checkpoint) >= *period;
  }
};

void stop_if_asked(Run& run) {
  const int signal = StopSignals::received();
  if (signal == 0) return;
  run.write_checkpoint(fmt::format("stopped: {}", signal_name(signal)));
  run.recorder.finish_progress();
  throw Stopped(signal, fmt::format("stopped by {} at t = {:.6g} s; the checkpoint is in {}: go on with --resume",
                                    signal_name(signal), run.simulation.state().time, run.options.out.string()));
}

void advance(Run& run) {
  Simulation& simulation = run.simulation;
  const double end = simulation.model().scene.time.end;
  run.recorder.begin(simulation);
  simulation.phases() = {};
  const Observer outputs{[&] { return std::min(end, run.recorder.next_output()); },
                         [&] {
                           simulation.phases().apart(Phase::output, [&] {
                             run.write_outputs();
                             if (simulation.state().time >= end) run.see_end();
                           });
                           return !run.has_ended();
                         }};
  if (outputs.write()) run.recorder.write_summary(simulation, "running");
  const bool stops = simulation.model().scene.time.stop_at_outputs;
  while (!run.has_ended()) {
    const double until = stops ? outputs.next_time() : std::numeric_limits<double>::infinity();
    const StepReport report = simulation.step(until, &outputs);
    if (report.dt > 0 && outputs.is_due_at(simulation.state().time)) outputs.write();
    if (report.dt > 0) run.recorder.record_step(simulation, report);
    if (run.has_ended()) break;
    stop_if_asked(run);
    if (run.checkpoint_due()) run.write_checkpoint("running");
  }
  run.write_end();
  run.recorder.finish_progress();
}

/// A failed run's last words: its summary, what there is to go on from, and what there is to understand of a failed
/// step. Returns the message.
std::string last_words(Run& run, const Error& error) {
  run.recorder.finish_progress();
  try {
    run.recorder.write_summary(run.simulation, std::string("failed: ") + error.what());
    if (const auto* failed = dynamic_cast<const StepFailure*>(&error)) {
      write_file_atomically(failure_file(run.options.out),
                            failure_json(failed->failure, run.simulation, failed->what()));
      run.recorder.record_last_frame(run.simulation);
    }
  } catch (const OutputError&) {
    // The disk is full, which `error` tells already.
  }
  const double time = run.recorder.figures.checkpoint_time;
  return fmt::format("{}; results up to there are in {}, {}", error.what(), run.options.out.string(),
                     time < 0 ? "no checkpoint yet" : fmt::format("last good checkpoint: t = {:.6g} s", time));
}

/// Simulates until the end; `checkpoint`: where to start, or nullptr.
void simulate(const Scene& scene, const RunOptions& options, const Checkpoint* checkpoint, Clock::time_point start) {
  const std::unique_ptr<const StartFile> from = checkpoint ? nullptr : start_file_of(scene);
  const Model model = build_model(scene);
  if (checkpoint) checkpoint->require_bodies_of(model);
  make_samplers(model);  // refuses nodes that no body has, before anything is written
  Simulation simulation = start_simulation(model, from.get());
  if (const std::optional<std::string> warning = of_short_edges(model)) spdlog::warn(*warning);
  // Read before the folder is emptied: the scene may lie in it.
  const SceneFiles files(scene.file);
  const StopSignals signals;  // a run that was begun ends in order
  FolderLock::refuse_taken(options.out);
  if (!checkpoint) check_output_folder(options.out, options.force || options.resume);
  const FolderLock lock(options.out);
  checkpoint ? remove_temporary_files(options.out) : empty_output_folder(options.out, files.names());
  Recorder recorder(model, options.out, options.quiet, checkpoint ? Opening::resume : Opening::create);
  if (checkpoint) checkpoint->restore(simulation, recorder);
  if (from) write_file_atomically(options.out / start_copy_name, from->bytes());
  if (from) recorder.figures.started_from = from->origin();
  files.write(options.out);
  recorder.figures.threads = omp_get_max_threads();
  recorder.figures.preparation_seconds = seconds_since(start);
  if (checkpoint) recorder.figures.checkpoint_time = checkpoint->time();
  fs::remove(failure_file(options.out));
  fs::remove(options.out / start_file_name);  // of an earlier end
  if (!options.quiet)
    fmt::print("{}: {} bodies, {} nodes, {} DOFs, prepared in {:.2f} s{}\n", scene.name, model.bodies.size(),
               model.node_count(), model.dof_count(), recorder.figures.preparation_seconds,
               checkpoint ? fmt::format(", going on from t = {:.6g} s", checkpoint->time())
               : from     ? fmt::format(", starting from '{}' at its t = {:.6g} s", from->scene_name(), from->time())
                          : "");
  Run run{options, files.text(), simulation, recorder};
  try {
    advance(run);
  } catch (const PhysicsError& error) {
    throw PhysicsError(last_words(run, error));
  } catch (const OutputError& error) {
    throw OutputError(last_words(run, error));
  }
  if (!options.quiet) fmt::print("{}", run.end_line);
}

nlohmann::json summary_in(const fs::path& folder) {
  const fs::path file = folder / "summary.json";
  if (!fs::exists(file)) return nlohmann::json::object();
  return nlohmann::json::parse(read_text_file(file, "a summary (summary.json)"), nullptr, false);
}

/// Whether the folder's last run left it in order at this checkpoint. One that was killed after its last checkpoint,
/// but before its summary was written and its lock removed, did not.
bool ended_in_order(const fs::path& folder, const Checkpoint& checkpoint) {
  const nlohmann::json summary = summary_in(folder);
  return summary.is_object() && summary.value("status", "running") != "running" &&
         summary.value("time", -1.0) == checkpoint.time() && !fs::exists(folder / "run.lock");
}

/// Whether a run has nothing left to do at a checkpoint, but to remove another's trials to write. Says so.
bool nothing_to_do(const Checkpoint& checkpoint, double end, const RunOptions& options) {
  if (checkpoint.time() < end) return false;
  if (checkpoint.time() == end && !ended_in_order(options.out, checkpoint)) return false;
  remove_temporary_files(options.out);  // of a run that was to overwrite this one and was killed before it began
  if (!options.quiet)
    fmt::print("{}: has reached t = {:.6g} s already; nothing to do (a later --until goes on)\n", options.out.string(),
               checkpoint.time());
  return true;
}

/// Throws InputError for another scene than the checkpoint's.
void require_scene_of(const Checkpoint& checkpoint, const Scene& scene, const fs::path& folder) {
  const SceneFiles files(scene.file);
  const std::string difference = scene_difference(checkpoint.scene_text(), files.text());
  if (!difference.empty())
    throw InputError(
        fmt::format("{}: not the scene of the checkpoint in {}: {}; only the end, the title and "
                    "[checkpoint] may change",
                    scene.file.string(), folder.string(), difference));
  files.compare(folder);
  require_same_start(scene, folder);
}

/// Of a run that was killed before its first checkpoint, when the state that it began from is kept in its folder alone.
Scene with_kept_start(const Scene& scene, const fs::path& folder) {
  Scene kept = scene;
  const fs::path copy = folder / start_copy_name;
  if (!scene.start_from.empty() && !fs::exists(scene.start_from) && fs::exists(copy)) kept.start_from = copy;
  return kept;
}

}  // namespace

void run_scene(const Scene& scene, const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  set_threads(options.threads);
  if (!options.resume) return simulate(scene, options, nullptr, start);
  if (begins_anew(options.out)) {
    if (!options.quiet) fmt::print("{}: has no checkpoint yet; starting anew\n", options.out.string());
    return simulate(with_kept_start(scene, options.out), options, nullptr, start);
  }
  const Checkpoint checkpoint(options.out);
  require_scene_of(checkpoint, scene, options.out);
  if (nothing_to_do(checkpoint, scene.time.end, options)) return;
  checkpoint.warn_of_other_build();
  simulate(scene, options, &checkpoint, start);
}

Scene scene_of_folder(const fs::path& folder) {
  if (!fs::exists(folder)) throw InputError(fmt::format("{}: no such folder; name the scene file", folder.string()));
  std::string name;
  if (!begins_anew(folder))
    name = Checkpoint(folder).scene_name();
  else if (const nlohmann::json summary = summary_in(folder); summary.contains("scene"))
    name = summary.value("scene", "");
  else
    throw OutputError(
        fmt::format("{}: a run was killed before it wrote anything of use; name its scene file", folder.string()));
  Scene scene = read_scene(folder / "scene.toml");
  scene.name = name;
  return scene;
}

}  // namespace pliant
