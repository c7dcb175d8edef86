#pragma once

#include <filesystem>
#include <string>

#include "results/recorder.hpp"

namespace pliant {

/// checkpoint.bin of an output folder: everything that a run needs to go on, and the scene and build that it belongs
/// to. Writing one changes no bit of the run. `time`: up to which there are results, s.
void write_checkpoint(const std::filesystem::path& folder, const std::string& scene_text, Simulation& simulation,
                      Recorder& recorder, double time);

/// What decides about the last bits: commit, compiler, options, instructions.
std::string build_identity();

/// Hash of all that array sizes follow from: a build that meshes a scene otherwise cannot go on.
std::string mesh_hash(const Model& model);

/// Hash of what the bodies of a scene are before they move: their outlines, nodes, sizes, places and angles, each to a
/// millionth of an outline's segment, or of 1, so that builds that round otherwise agree.
std::string bodies_hash(const Model& model);

/// A checkpoint that was read and is not used yet.
class Checkpoint {
 public:
  /// Throws OutputError when there is none, or a damaged one.
  explicit Checkpoint(const std::filesystem::path& folder);

  const std::string& scene_text() const { return scene_text_; }
  const std::string& scene_name() const { return scene_name_; }
  double time() const { return time_; }  ///< up to which there are results, s
  /// Warns of a checkpoint of another build, whose next bits may differ.
  void warn_of_other_build() const;
  /// Throws InputError for other bodies, as by an outline or a table of grains that was changed since.
  void require_bodies_of(const Model& model) const;
  /// Puts everything into a simulation of the same scene and a recorder that resumes its folder; files are cut back to
  /// the checkpoint. Throws OutputError for what does not fit, the simulation and the files are then not to be used.
  void restore(Simulation& simulation, Recorder& recorder) const;

 private:
  std::filesystem::path path_;
  CheckpointText text_;
  std::string scene_text_, scene_name_, build_, mesh_, bodies_;
  double time_ = 0;
};

}  // namespace pliant
