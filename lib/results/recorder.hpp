#pragma once

#include <filesystem>
#include <string>

#include "files/checkpoint_file.hpp"
#include "results/frames.hpp"
#include "results/probes/probes.hpp"
#include "results/progress.hpp"
#include "results/step_log.hpp"
#include "results/summary.hpp"

namespace pliant {

/// One run's outputs, opened together and kept in step with the simulation.
class Recorder {
 public:
  Recorder(const Model& model, const std::filesystem::path& folder, bool quiet, Opening opening);

  void begin(const Simulation& simulation) { progress_.begin(simulation); }
  double next_output() const;  ///< s
  /// Those that are due. Returns whether there is a new frame.
  bool record_outputs(Simulation& simulation);
  /// A frame of now, if there are frames, whether due or not: a run that goes on from a checkpoint cuts it off.
  void record_last_frame(Simulation& simulation) { frames_.record_last(simulation); }
  void record_step(Simulation& simulation, const StepReport& report);
  /// All rows are on the disk, and the figures are those of now.
  void sync();
  /// summary.json of now. `status` as in summary_json.
  std::string summary(Simulation& simulation, const std::string& status);
  void write_summary(const std::string& text) const;
  void write_summary(Simulation& simulation, const std::string& status) { write_summary(summary(simulation, status)); }
  void finish_progress() const { progress_.finish(); }

  RunFigures figures;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("probes", probes_);
    visitor("frames", frames_);
    visitor("steps", steps_);
    visitor("worst_momentum_error", figures.worst_momentum_error);
    visitor("wall_seconds", figures.wall_seconds);
    visitor("resumed", figures.resumed);
    visitor("started_from", figures.started_from);
    visitor("warnings", figures.warnings);
    visitor("warned_of_folds", figures.warned_of_folds);
  }
  void loaded();

 private:
  void flush();

  std::filesystem::path folder_;
  ProbeRecorder probes_;
  FrameRecorder frames_;
  StepLog steps_;
  ProgressLine progress_;
  double seconds_before_ = 0;  ///< of wall time, before this process
};

}  // namespace pliant
