#include "results/run.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "results/frames.hpp"
#include "results/probes.hpp"
#include "results/progress.hpp"
#include "results/step_log.hpp"
#include "results/summary.hpp"

namespace pliant {
namespace {

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// One run's outputs, opened together and kept in step with the simulation.
class Recorder {
 public:
  Recorder(const Model& model, const RunOptions& options, const std::string& scene_text)
      : folder_(options.out),
        probes_(model, options.out),
        frames_(model, options.out),
        steps_(options.out),
        progress_(options.quiet) {
    write_file_atomically(folder_ / "scene.toml", scene_text);
  }

  double next_output(double end) const { return std::min({end, probes_.next_time(), frames_.next_time()}); }

  void record_outputs(Simulation& simulation) {
    probes_.record_due(simulation);
    frames_.record_due(simulation);
  }

  void record_step(Simulation& simulation, const StepReport& report) {
    steps_.record(simulation.state(), report);
    Audit audit;
    if (!progress_.show_if_due(simulation, report, audit)) return;
    figures.worst_momentum_error = std::max(figures.worst_momentum_error, audit.momentum_error);
    probes_.flush();
    steps_.flush();
  }

  void finish(Simulation& simulation, const std::string& failure = "") {
    figures.wall_seconds = progress_.seconds();
    figures.evaluations = simulation.state().evaluations;
    progress_.finish();
    probes_.flush();
    steps_.flush();
    write_file_atomically(folder_ / "summary.json", summary_json(simulation, figures, failure));
  }

  RunFigures figures;

 private:
  std::filesystem::path folder_;
  ProbeRecorder probes_;
  FrameRecorder frames_;
  StepLog steps_;
  ProgressLine progress_;
};

void advance(Simulation& simulation, Recorder& recorder) {
  const double end = simulation.model().scene.time.end;
  recorder.record_outputs(simulation);
  while (simulation.state().time < end) {
    const StepReport report = simulation.step(recorder.next_output(end));
    recorder.record_outputs(simulation);
    recorder.record_step(simulation, report);
  }
}

void print_summary(Simulation& simulation, const RunFigures& figures, const RunOptions& options) {
  const State& state = simulation.state();
  const Audit audit = simulation.audit();
  fmt::print(
      "{}: t = {:.6g} s in {:.1f} s, {} steps, {} rejected, {} evaluations ({:.0f}/s), energy balance {:.2e}, momentum "
      "{:.1e}\n",
      options.out.string(), state.time, figures.wall_seconds, state.steps, state.rejections, state.evaluations,
      static_cast<double>(figures.evaluations) / figures.wall_seconds, simulation.balance_error(audit.energy),
      std::max(audit.momentum_error, figures.worst_momentum_error));
}

}  // namespace

void run_scene(const Scene& scene, const RunOptions& options) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  const auto start = std::chrono::steady_clock::now();
  const Model model = build_model(scene);
  Simulation simulation(model);
  // Read before the folder is emptied: the scene may lie in it.
  const std::string scene_text = read_text(scene.file);
  prepare_output_folder(options.out, options.force);
  Recorder recorder(model, options, scene_text);
  recorder.figures.threads = omp_get_max_threads();
  recorder.figures.preparation_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.quiet)
    fmt::print("{}: {} bodies, {} nodes, {} DOFs, prepared in {:.2f} s\n", scene.name, model.bodies.size(),
               model.node_count(), model.dof_count(), recorder.figures.preparation_seconds);
  try {
    advance(simulation, recorder);
  } catch (const PhysicsError& error) {
    recorder.finish(simulation, error.what());
    throw PhysicsError(fmt::format("{}; results up to there are in {}", error.what(), options.out.string()));
  }
  recorder.finish(simulation);
  if (!options.quiet) print_summary(simulation, recorder.figures, options);
}

}  // namespace pliant
