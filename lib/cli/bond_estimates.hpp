#pragma once

#include <string>
#include <vector>

#include "bonds/bond_system.hpp"

namespace pliant {

/// Lines on the bonds at the start: their number, the compliance that they add, and the resolution of their process
/// zone. None without bonds.
std::vector<std::string> describe_bonds(const Model& model, const BondSystem& bonds);

}  // namespace pliant
