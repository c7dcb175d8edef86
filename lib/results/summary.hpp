#pragma once

#include <string>
#include <vector>

#include "dynamics/simulation.hpp"

namespace pliant {

/// Wall-clock figures of a run, over all processes that took part in it.
struct RunFigures {
  double preparation_seconds = 0;  ///< of this process
  double wall_seconds = 0;
  double process_seconds = 0;       ///< of these, of this process
  double worst_momentum_error = 0;  ///< over all audits of the run
  int threads = 1;
  std::string started_from{};           ///< JSON of the state that the run started from; empty: none
  int resumed = 0;                      ///< times that the run went on from a checkpoint
  double checkpoint_time = -1;          ///< s of the scene; -1: none yet
  std::vector<std::string> warnings{};  ///< of its steps; those of its start and its end are each process's own
  bool warned_of_folds = false;         ///< that a frame showed; no further frame is searched for them
};

/// summary.json: what a run was, what it cost and how well its energy balance closes. `status`: "running" (at the last
/// checkpoint, or the start), "finished", "stopped: SIGINT" or "failed: ..." with the reason.
std::string summary_json(Simulation& simulation, const RunFigures& figures, const std::string& status);

}  // namespace pliant
