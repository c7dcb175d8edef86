#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace pliant {

/// Index of the share of each of `count` items, one after the other. The next share is the one with the greatest
/// share/(2 n + 1), if it has n items already, and the first of equal ones (Sainte-Lague's sequence). Equal shares take
/// strict turns; any first k items have each share to about one item. Shares sum to 1.
std::vector<int> take_turns(const std::vector<double>& shares, int count);

/// Index of the share of each grain of a packing, by its number. Shares take turns up each column of a lattice, column
/// after column; along given positions as they are listed.
std::vector<int> species_in_turn(const std::vector<double>& shares, const Packing& packing);

}  // namespace pliant
