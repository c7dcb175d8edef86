#pragma once

#include <string>

#include "dynamics/failure.hpp"
#include "dynamics/simulation.hpp"

namespace pliant {

/// failure.json: where and why a run ended, for programs, with the outlines of the bodies that it is about as they were
/// in the last good state, for a picture. `message`: the words for people.
std::string failure_json(const Failure& failure, const Simulation& simulation, const std::string& message);

}  // namespace pliant
