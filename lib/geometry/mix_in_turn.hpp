#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace pliant {

/// For each of `count` things, one after another, the index of its share: always the one that most lacks a thing, which
/// is that of the greatest share/(2 n + 1) if it has n already, and the first of equals (Sainte-Lague's sequence).
/// Equal shares take strict turns; any first k things have each share to about one thing. Shares sum to 1.
std::vector<int> take_turns(const std::vector<double>& shares, int count);

/// For each grain of a packing, by its number, the index of its share when shares take turns up each column of a
/// lattice, column after column; along given positions as they are listed.
std::vector<int> mix_in_turn(const std::vector<double>& shares, const Packing& packing);

}  // namespace pliant
