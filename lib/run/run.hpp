#pragma once

#include <filesystem>
#include <optional>

#include "scene/scene.hpp"

namespace pliant {

struct RunOptions {
  std::filesystem::path out;
  bool force = false, quiet = false;
  int threads = 0;      ///< 0: as OpenMP chooses
  bool resume = false;  ///< goes on from the folder's checkpoint, or starts anew when killed before one
};

/// Simulates a scene to its end and writes the output folder, with a checkpoint every Scene::checkpoint_period of wall
/// time and at the end. With `resume` from the folder's checkpoint on, else from 0; whenever the earlier run was
/// killed, the folder is then that of a run that was not: without a checkpoint it starts anew, at its end it is put in
/// order. A physics failure leaves readable outputs with a summary that names it, and is thrown on. SIGINT and SIGTERM
/// end the run after the present step, with a checkpoint: throws Stopped. Throws InputError for another scene than the
/// checkpoint's, OutputError for folders and files that cannot be used.
void run_scene(const Scene& scene, const RunOptions& options);

/// The scene of a folder's run, under its name. Throws OutputError without a checkpoint, unless the run was killed
/// before its first one.
Scene scene_of_folder(const std::filesystem::path& folder);

}  // namespace pliant
