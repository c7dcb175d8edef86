#include "results/recorder.hpp"

#include <algorithm>

#include "files/atomic_file.hpp"
#include "files/text_output.hpp"

namespace pliant {

Recorder::Recorder(const Model& model, const std::filesystem::path& folder, bool quiet, Opening opening)
    : folder_(folder),
      probes_(model, folder, opening),
      frames_(model, folder, opening),
      steps_(folder, opening),
      progress_(quiet) {}

double Recorder::next_output() const { return std::min(probes_.next_time(), frames_.next_time()); }

bool Recorder::record_outputs(Simulation& simulation) {
  probes_.record_due(simulation);
  return frames_.record_due(simulation);
}

void Recorder::record_step(Simulation& simulation, const StepReport& report) {
  steps_.record(simulation.state(), report);
  EnergyBalance audit;
  if (!progress_.show_if_due(simulation, report, audit)) return;
  figures.worst_momentum_error = std::max(figures.worst_momentum_error, audit.momentum_error);
  flush();
}

void Recorder::flush() {
  probes_.flush();
  steps_.flush();
  figures.process_seconds = progress_.seconds();
  figures.wall_seconds = seconds_before_ + figures.process_seconds;
}

void Recorder::sync() {
  flush();
  probes_.sync();
  steps_.sync();
}

std::string Recorder::summary(Simulation& simulation, const std::string& status) {
  flush();
  return summary_json(simulation, figures, status);
}

void Recorder::write_summary(const std::string& text) const { write_file_atomically(folder_ / "summary.json", text); }

void Recorder::loaded() {
  seconds_before_ = figures.wall_seconds;
  ++figures.resumed;
}

}  // namespace pliant
