#pragma once

#include <filesystem>

#include "reference/time_stepping.hpp"

namespace pliant::reference {

struct RunOptions {
  std::filesystem::path out;
  bool force = false, quiet = false;
  bool verbose = false;  ///< a line of progress for every step
  SolverOptions solver;  ///< dt 0: chosen by default_step
};

/// Default step: the time of the fastest wave of the scene over one segment of its finest outline, s. For statics and
/// scenes without compliant bodies it is a hundredth of the scene's time.
double default_step(const Bodies& bodies, bool statics);

/// Solves a scene to its end and writes a folder of results as the engine does, for `compare`. A failure leaves
/// readable outputs with a summary that names it, and is rethrown. SIGINT and SIGTERM end the run after the present
/// step in the same way, by Stopped. Warns if the steps have created energy.
void run_scene(const Scene& scene, const RunOptions& options);

}  // namespace pliant::reference
