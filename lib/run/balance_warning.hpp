#pragma once

#include "dynamics/simulation.hpp"

namespace pliant {

/// Warns of an energy balance off by more than 1 % and says what to change; `energy`: of the present state.
void warn_of_balance(const Simulation& simulation, const Energies& energy);

}  // namespace pliant
