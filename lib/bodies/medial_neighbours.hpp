#pragma once

#include "bodies/outline.hpp"

namespace pliant {

/// Finds of each segment of an outline those, next ones apart, with which it shares a piece of the medial axis less
/// than `depth` below: further inside a point is nearer to them, though it is beside the segment. None in round shapes,
/// and in others near sharp corners, across short edges and thin parts. The same of nodes, as far as these are
/// re-entrant. And which segments are next to shorter ones.
void find_medial_neighbours(OutlineShape& shape, double depth);

}  // namespace pliant
