#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/simulation.hpp"

namespace pliant::halo {

/// 64-bit FNV-1a hash of time, step sizes, counts of steps, and positions, momenta and forces of all bodies in their
/// order. Energies and history variables are left out: energies do not act on the motion, and each process has the
/// history of its own pairs. `owner`: [bodies], as find_owners returns it; empty: this process has all bodies.
/// Collective unless it is empty; only process 0 returns the hash.
std::uint64_t motion_hash(const Simulation& simulation, const std::vector<int>& owner);

}  // namespace pliant::halo
