#pragma once

#include "bodies/outline_fields.hpp"

namespace pliant {

/// Finds the medial neighbours of each segment of an outline: those, except adjacent ones, with which it shares a piece
/// of the medial axis less than `depth` below. Points further inside are nearer to them, though they project onto the
/// segment. Round shapes have none; others have them near sharp corners, across short edges and thin parts. Re-entrant
/// nodes have medial neighbours likewise. It also marks segments that are next to shorter ones.
void find_medial_neighbours(OutlineShape& shape, double depth);

}  // namespace pliant
