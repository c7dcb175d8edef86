#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"

namespace pliant::halo {

constexpr int every_process = -1;  ///< owner of walls: all processes advance them

/// Owner of each body, [bodies], by recursive coordinate bisection at these outlines. The bodies of one batch stay
/// together, because one vector register holds them. Parts have about equal numbers of nodes. Throws InputError if
/// there are fewer batches and rigid grains than processes.
std::vector<int> find_owners(const Model& model, const OutlineField& outlines, int processes);

/// Bodies that a process advances: its own grains, and all walls.
OwnBodies own_bodies(const Model& model, const std::vector<int>& owner, int process);

}  // namespace pliant::halo
