#pragma once

#include <vector>

#include "reference/bonds/bond.hpp"

namespace pliant::reference {

/// Bonds that a rule makes at outline positions x [all outline nodes], m, by brute force: each segment of a slave
/// against each segment of its master and of all of its images. Of two bodies the one with the finer outline is the
/// slave, and a grain before a wall. A body is not bonded to itself or its own images.
///
/// A segment is bonded if
/// - neither end is further from the master than the rule's gap, measured across the middle line;
/// - neither is further from it than half of a mean segment, or the gap if that is more. This leaves out segments that
///   the master covers by less than half, and surfaces that overlap deeply;
/// - the middle line between both surfaces follows the segment.
std::vector<Bond> find_bonds(const Scene& scene, const std::vector<ContactOutline>& outlines, const Points& x,
                             const Periods& periods, int rule);

}  // namespace pliant::reference
