#pragma once

#include <string>

#include "dynamics/simulation.hpp"

namespace pliant {

/// Wall-clock figures of a run.
struct RunFigures {
  double preparation_seconds = 0, wall_seconds = 0;
  long evaluations = 0;
  double worst_momentum_error = 0;  ///< over all audits of the run
  int threads = 1;
};

/// Largest resident memory of this process so far, bytes.
long peak_memory_bytes();

/// summary.json: what a run was, what it cost and how well its books balance; `failure`: why it stopped early, or empty.
std::string summary_json(Simulation& simulation, const RunFigures& figures, const std::string& failure);

}  // namespace pliant
