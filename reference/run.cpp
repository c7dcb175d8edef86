#include "reference/run.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "build_info.hpp"
#include "core/errors.hpp"
#include "core/memory.hpp"
#include "core/stop_signals.hpp"
#include "files/atomic_file.hpp"
#include "files/folder_lock.hpp"
#include "files/output_folder.hpp"
#include "files/text_output.hpp"
#include "reference/outputs/frames.hpp"
#include "reference/outputs/probes.hpp"
#include "reference/overlap.hpp"
#include "reference/progress.hpp"
#include "scene/line_reader.hpp"

namespace pliant::reference {
namespace {

/// Share of its energy that a run may create without a warning: well resolved rebounds stay below
/// (verify/energy_drift).
constexpr double made_energy = 0.01;

/// Energy of strains of 1e-12, and of weights at coordinates with rounding, J/m.
double least_energy(const Bodies& bodies) {
  double energy = 0;
  const Vec2 gravity = bodies.scene().gravity_at(0);
  for (const Body& body : bodies.all()) {
    const Material& material = bodies.material_of(body);
    if (body.compliant()) energy += 1e-24 * material.young * body.mass / material.density;
    energy += 1e-13 * body.mass * gravity.cwiseAbs().dot(body.placed.centre.cwiseAbs());
  }
  return energy;
}

/// Statistics of contacts in a run.
struct ContactsSeen {
  bool any = false;
  double deepest = 0;  ///< over the master's longest segment

  void add(const Forces& forces) {
    any |= forces.contacts.count() > 0;
    deepest = std::max(deepest, forces.deepest);
  }
};

/// Text with the reason why time steps have created energy, and advice.
std::string cause(const ContactsSeen& seen, const Overlap& overlap, double dt, double hht) {
  constexpr double deep = 0.3, shallow = 0.1;  // over a segment
  const std::string shorter =
      fmt::format("give a smaller --dt, such as {:.2g} s{}", dt / 4, hht == 0 ? ", or --hht -0.1" : "");
  if (overlap.share > deep && overlap.share >= 0.9 * seen.deepest)
    return fmt::format("'{}' and '{}' overlapped by {:.2g} of a segment at the start: move them apart", overlap.first,
                       overlap.second, overlap.share);
  if (seen.deepest > deep)
    return fmt::format(
        "contacts got {:.2g} of a segment deep: take a stiffness {:.2g} times as high, "
        "which leaves {:g} of an impact's, and {}",
        seen.deepest, std::pow(seen.deepest / shallow, 2), shallow, shorter);
  return fmt::format("steps of {:.3g} s are long against the vibrations of its {}: {}", dt,
                     seen.any ? "contacts" : "bodies, which nothing touched", shorter);
}

/// Output files of a run.
class Outputs {
 public:
  Outputs(const System& system, const TimeStepping& run, const RunOptions& options)
      : system_(system),
        run_(run),
        options_(options),
        overlap_(find_overlap(system.bodies(), run.forces())),
        progress_(options.quiet     ? Progress::Detail::none
                  : options.verbose ? Progress::Detail::steps
                                    : Progress::Detail::periodic,
                  system.bodies().scene().time.end),
        probes_(system.bodies(), options.out),
        frames_(system.bodies(), options.out),
        steps_(options.out / "steps.csv",
               {"time [s]", "dt [s]", "error [-]", "rejections", "evaluations", "contacts", "least_jacobian [-]"}) {
    for (const std::string& name : probes_.left_out())
      spdlog::warn("probe '{}': the reference solver does not measure this quantity", name);
    for (const std::string& name : frames_.left_out())
      spdlog::warn("[frames] fields: the reference solver does not write '{}'", name);
    progress_.say(advice_on(overlap_));
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
    longest_step_ = std::max(longest_step_, record.dt);
    effort.bisections += record.bisections, effort.iterations += record.iterations;
    if (run_.balance().made() > most_made_) most_made_ = run_.balance().made(), most_made_at_ = run_.motion().time;
    const Forces& forces = run_.forces();
    contacts_seen_.add(forces);
    steps_.row({run_.motion().time, record.dt, record.residual, static_cast<double>(effort.bisections),
                static_cast<double>(effort.iterations), static_cast<double>(forces.contacts.count()),
                least_jacobian(forces)});
    steps_.flush();
    progress_.show_if_due(run_, record, effort);
  }

  void stop_if_asked() const {
    const int signal = StopSignals::received();
    if (signal == 0) return;
    throw Stopped(signal, fmt::format("stopped by {} at t = {:.6g} s; results up to there are in {}; there are no "
                                      "checkpoints: --force starts anew",
                                      signal_name(signal), run_.motion().time, options_.out.string()));
  }

  void write_summary(const std::string& status) const {
    write_file_atomically(options_.out / "summary.json", summary(status).dump(2) + "\n");
  }

  /// Writes the last summary and the final messages.
  void finish(const std::string& status) {
    progress_.finish();
    write_summary(status);
    const double scale = run_.balance().scale();
    if (options_.solver.statics || most_made_ <= made_energy * scale + least_energy(system_.bodies())) return;
    spdlog::warn(
        "the time steps have made energy: up to {:.2g} % of what the scene had or took up, at t = {:.6g} s; {}",
        100 * most_made_ / scale, most_made_at_, cause(contacts_seen_, overlap_, longest_step_, options_.solver.hht));
  }

 private:
  nlohmann::ordered_json summary(const std::string& status) const {
    const Scene& scene = system_.bodies().scene();
    const EnergyBalance& balance = run_.balance();
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
    json["wall_seconds"] = progress_.seconds();
    json["energy"] = {{"kinetic", balance.kinetic},
                      {"strain", balance.strain},
                      {"contact", balance.contact},
                      {"boundary", balance.boundary},
                      {"dissipated", balance.dissipated()},
                      {"external_work", balance.external_work()},
                      {"balance_error", balance.balance_error()}};
    json["initial_overlap"] = {{"pairs", overlap_.pairs},
                               {"depth", overlap_.depth},
                               {"depth_over_segment", overlap_.share},
                               {"stored_energy", overlap_.stored}};
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
  double most_made_ = 0, most_made_at_ = 0;  ///< spurious energy, J/m, and its time, s
  double longest_step_ = 0;                  ///< s
  ContactsSeen contacts_seen_;
  Overlap overlap_;
  Progress progress_;
  ProbeFile probes_;
  FrameOutput frames_;
  CsvFile steps_;
};

/// Advances with equal steps from one output to the next.
void advance(const System& system, TimeStepping& run, Outputs& outputs, double dt) {
  const double end = system.bodies().scene().time.end;
  const std::vector<double> switches = system.loads().switch_times();
  outputs.record_due();
  while (run.motion().time < end) {
    const double now = run.motion().time;
    double until = outputs.next_time(end);
    const auto next = std::upper_bound(switches.begin(), switches.end(), now);
    if (next != switches.end()) until = std::min(until, *next);
    const int parts = std::max(1, static_cast<int>(std::ceil((until - now) / dt * (1 - 1e-9))));
    for (int part = 1; part <= parts; ++part) {
      outputs.record_step(run.step(part == parts ? until : now + (until - now) * part / parts));
      if (part < parts) outputs.stop_if_asked();
    }
    outputs.record_due();
    if (run.motion().time < end) outputs.stop_if_asked();
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
      read_text_file(scene.file, "a scene file (.toml)");  // before the folder is emptied, as it may contain the scene
  FolderLock::refuse_taken(options.out);
  prepare_output_folder(options.out, options.force);
  const FolderLock lock(options.out);
  Outputs outputs(system, run, options);
  write_file_atomically(options.out / "scene.toml", text);
  outputs.write_summary("running");
  const StopSignals signals;
  try {
    advance(system, run, outputs, solver.dt);
  } catch (const Stopped&) {
    outputs.finish(fmt::format("stopped: {}", signal_name(StopSignals::received())));
    throw;
  } catch (const Error& error) {
    outputs.finish(std::string("failed: ") + error.what());
    throw;
  }
  outputs.finish("finished");
  if (options.quiet) return;
  fmt::print("{}: t = {:.6g} s, {} steps, {} halved, {} Newton iterations, energy balance {:.2e}\n",
             options.out.string(), run.motion().time, outputs.effort.steps, outputs.effort.bisections,
             outputs.effort.iterations, run.balance().balance_error());
}

}  // namespace pliant::reference
