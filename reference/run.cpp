#include "reference/run.hpp"

#include <chrono>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "build_info.hpp"
#include "core/errors.hpp"
#include "core/memory.hpp"
#include "files/folder_lock.hpp"
#include "reference/outputs/frames.hpp"
#include "reference/outputs/probes.hpp"
#include "scene/text_file.hpp"

namespace pliant::reference {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// What a run has cost so far.
struct Effort {
  long steps = 0, bisections = 0, iterations = 0;
};

/// A run's files.
class Outputs {
 public:
  Outputs(const System& system, const TimeStepping& run, const RunOptions& options)
      : system_(system),
        run_(run),
        options_(options),
        probes_(system.bodies(), options.out),
        frames_(system.bodies(), options.out),
        steps_(options.out / "steps.csv",
               {"time [s]", "dt [s]", "error [-]", "rejections", "evaluations", "contacts", "least_jacobian [-]"}) {
    for (const std::string& name : probes_.left_out())
      spdlog::warn("probe '{}': the reference solver does not measure this quantity", name);
    for (const std::string& name : frames_.left_out())
      spdlog::warn("[frames] fields: the reference solver does not write '{}'", name);
  }

  Effort effort;

  double next_time(double end) const { return std::min({end, probes_.next_time(), frames_.next_time()}); }

  void record_due() {
    const View view(system_, run_);
    probes_.record_due(view);
    frames_.record_due(view);
  }

  void record_step(const StepRecord& record) {
    ++effort.steps;
    effort.bisections += record.bisections, effort.iterations += record.iterations;
    const Forces& forces = run_.forces();
    const auto touching = static_cast<double>(forces.contacts.elements.size());
    steps_.row({run_.motion().time, record.dt, record.residual, static_cast<double>(effort.bisections),
                static_cast<double>(effort.iterations), touching, jacobian()});
    steps_.flush();
    if (options_.quiet) return;
    fmt::print(stderr, "t = {:.6g} s: {} Newton iterations, residual {:.1e}, least J {:.4f}, {} contact nodes{}\n",
               run_.motion().time, record.iterations, record.residual, jacobian(), touching,
               record.bisections > 0 ? fmt::format(", step halved {} times", record.bisections) : "");
  }

  void write_summary(const std::string& status) const {
    write_file_atomically(options_.out / "summary.json", summary(status).dump(2) + "\n");
  }

 private:
  /// Of compliant bodies; 1 without any.
  double jacobian() const {
    return std::min(1e300, run_.forces().least_jacobian) < 1e300 ? run_.forces().least_jacobian : 1.0;
  }

  nlohmann::ordered_json summary(const std::string& status) const {
    const Scene& scene = system_.bodies().scene();
    const Books& books = run_.books();
    const LinearSolver::Counts& counts = run_.solver_counts();
    nlohmann::ordered_json json;
    json["scene"] = scene.name;
    json["title"] = scene.title;
    json["solver"] = options_.solver.statics ? "reference, static" : "reference, Newmark";
    json["status"] = status;
    json["time"] = run_.motion().time;
    json["end"] = scene.time.end;
    json["steps"] = effort.steps;
    json["rejections"] = effort.bisections;
    json["evaluations"] = effort.iterations;
    json["wall_seconds"] = seconds_since(start_);
    json["energy"] = {{"kinetic", books.kinetic},
                      {"strain", books.strain},
                      {"contact", books.contact},
                      {"boundary", books.boundary},
                      {"dissipated", books.dissipated()},
                      {"external_work", books.external_work()},
                      {"balance_error", books.balance_error()}};
    json["factorisation"] = {
        {"analyses", counts.analyses}, {"factorisations", counts.factorisations}, {"seconds", counts.seconds}};
    json["peak_memory_bytes"] = peak_memory_bytes();
    json["bodies"] = system_.bodies().all().size();
    json["dofs"] = system_.bodies().dofs();
    json["commit"] = build_commit;
    json["compiler"] = build_compiler;
    return json;
  }

  const System& system_;
  const TimeStepping& run_;
  const RunOptions& options_;
  Clock::time_point start_ = Clock::now();
  ProbeFile probes_;
  FrameOutput frames_;
  CsvFile steps_;
};

/// Equal steps from one output to the next.
void advance(const System& system, TimeStepping& run, Outputs& outputs, double dt) {
  const double end = system.bodies().scene().time.end;
  const std::vector<double> switches = system.loads().switch_times();
  outputs.record_due();
  while (run.motion().time < end) {
    const double now = run.motion().time;
    double until = outputs.next_time(end);
    for (const double t : switches)
      if (t > now) until = std::min(until, t);
    const int parts = std::max(1, static_cast<int>(std::ceil((until - now) / dt * (1 - 1e-9))));
    for (int part = 1; part <= parts; ++part)
      outputs.record_step(run.step(part == parts ? until : now + (until - now) * part / parts));
    outputs.record_due();
  }
}

}  // namespace

double default_step(const Bodies& bodies, bool statics) {
  double fastest = 0;
  for (const Body& body : bodies.all()) {
    if (!body.compliant()) continue;
    const Material& m = bodies.material_of(body);
    const double stiffness = m.young * (1 - m.poisson) / ((1 + m.poisson) * (1 - 2 * m.poisson));
    fastest = std::max(fastest, std::sqrt(stiffness / m.density));
  }
  const double end = bodies.scene().time.end;
  return statics || fastest == 0 ? end / 100 : std::min(end, bodies.finest_spacing() / fastest);
}

void run_scene(const Scene& scene, const RunOptions& options) {
  System system(scene);
  SolverOptions solver = options.solver;
  if (solver.dt == 0) solver.dt = default_step(system.bodies(), solver.statics);
  TimeStepping run(system, solver);
  const std::string text =
      read_text_file(scene.file, "a scene file (.toml)");  // before the folder is emptied: the scene may lie in it
  FolderLock::refuse_taken(options.out);
  prepare_output_folder(options.out, options.force);
  const FolderLock lock(options.out);
  Outputs outputs(system, run, options);
  write_file_atomically(options.out / "scene.toml", text);
  outputs.write_summary("running");
  try {
    advance(system, run, outputs, solver.dt);
  } catch (const Error& error) {
    outputs.write_summary(std::string("failed: ") + error.what());
    throw;
  }
  outputs.write_summary("finished");
  fmt::print("{}: t = {:.6g} s, {} steps, {} halved, {} Newton iterations, energy balance {:.2e}\n",
             options.out.string(), run.motion().time, outputs.effort.steps, outputs.effort.bisections,
             outputs.effort.iterations, run.books().balance_error());
}

}  // namespace pliant::reference
