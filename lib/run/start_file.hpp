#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "dynamics/simulation.hpp"
#include "files/checkpoint_file.hpp"

namespace pliant {

/// Writes final.bin: the state now, at the end of a run, for others to start from, and the scene that it belongs to.
void write_start_file(const std::filesystem::path& folder, const std::string& scene_text, const Simulation& simulation);

/// The state that a scene starts from, read and not used yet.
class StartFile {
 public:
  /// `key`: where [start] from stands and what it says, for messages. Throws InputError for what is no such state.
  StartFile(const std::filesystem::path& file, std::string key);

  /// Throws InputError, with the key, for a scene of other bodies.
  void require_bodies_of(const std::filesystem::path& scene_file) const;
  /// Throws InputError for other bodies, OutputError for what another build wrote that stores them otherwise.
  StartPoint point(const Model& model) const;
  /// Of the run that left it: scene, time and state_hash. One line of JSON.
  std::string origin() const;
  const std::string& bytes() const { return text_.bytes; }  ///< of the file
  double time() const { return time_; }                     ///< at the end of that run, s
  const std::string& scene_name() const { return scene_name_; }
  const std::string& state_hash() const { return state_hash_; }

 private:
  std::filesystem::path path_;
  std::string key_;
  CheckpointText text_;
  std::string scene_text_, scene_name_, state_hash_, build_, mesh_, bodies_;
  double time_ = 0;
};

/// Of a scene that starts from a run's end, checked against its bodies; null for any other.
std::unique_ptr<const StartFile> start_file_of(const Scene& scene);

/// Of a scene whose run goes on in a folder: throws InputError when it names another state than the one it started
/// from, which the folder keeps. A state that is not there any more is not missed.
void require_same_start(const Scene& scene, const std::filesystem::path& folder);

/// Where a scene starts: from that file, if any.
Simulation start_simulation(const Model& model, const StartFile* file);

}  // namespace pliant
