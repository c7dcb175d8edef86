#pragma once

#include "files/frame_file.hpp"
#include "results/snapshot.hpp"

namespace pliant {

inline constexpr const char* contact_network_name = "contacts";

/// The table of a frame's pairs in touch, a row each:
///   bodies [2]    the first and the second, numbered as in the grids
///   images [1]    periods to add to x of the second to see it from the first; [2] with two periods, along both
///   point [2]     m, mean of the touching nodes weighted by their force's magnitude (by length where there is none),
///                 where the first body sees them: forces that are parallel have the moment of one that acts there
///   force [2]     N/m, on the second body: of the laws, without dashpots and energy correction
///   length [1]    m, of the touching nodes, the mean of both bodies' sides
/// Numbers of bodies are exact below 2^24.
FrameTable contact_network(const Snapshot& snapshot);

}  // namespace pliant
