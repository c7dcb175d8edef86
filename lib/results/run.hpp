#pragma once

#include <filesystem>
#include <optional>

#include "scene/scene.hpp"

namespace pliant {

struct RunOptions {
  std::filesystem::path out;
  bool force = false, quiet = false;
  int threads = 0;      ///< 0: as OpenMP chooses
  bool resume = false;  ///< goes on from the folder's checkpoint
};

/// Simulates a scene to its end and writes the output folder, with a checkpoint every Scene::checkpoint_period of wall
/// time and at the end. With `resume` from the folder's checkpoint on, else from 0. A physics failure leaves readable
/// outputs with a summary that names it, and is thrown on. SIGINT and SIGTERM end the run after the present step, with
/// a checkpoint: throws Stopped. Throws InputError for another scene than the checkpoint's, OutputError for folders and
/// files that cannot be used.
void run_scene(const Scene& scene, const RunOptions& options);

/// The scene that a folder's checkpoint belongs to, under its name. Throws OutputError without one.
Scene scene_of_checkpoint(const std::filesystem::path& folder);

}  // namespace pliant
