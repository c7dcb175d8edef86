#pragma once

#include "dynamics/simulation.hpp"

namespace pliant {

/// What the first second of a run tells.
struct DryRun {
  double time = 0;  ///< reached, s of the scene
  bool finished = false;
  std::int64_t evaluations = 0, rejections = 0;
  double seconds_per_evaluation = 0;
  double pace = 0;     ///< time of the scene per evaluation once the step has grown, s; 0: it was too short
  double next_dt = 0;  ///< s
};

/// Steps for at most a second, with the same outputs as a run, and samples the probes; nothing is written.
DryRun dry_run(Simulation& simulation);

}  // namespace pliant
