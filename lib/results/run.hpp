#pragma once

#include <filesystem>

#include "scene/scene.hpp"

namespace pliant {

struct RunOptions {
  std::filesystem::path out;
  bool force = false, quiet = false;
  int threads = 0;  ///< 0: as OpenMP chooses
};

/// Simulates a scene from 0 to its end and writes the output folder. A physics failure leaves readable outputs with a summary that names it,
/// and is thrown on.
void run_scene(const Scene& scene, const RunOptions& options);

}  // namespace pliant
