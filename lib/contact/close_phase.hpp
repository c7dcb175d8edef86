#pragma once

#include <vector>

#include "contact/broad_phase.hpp"
#include "contact/patch.hpp"

namespace pliant {

/// Finds the arcs through which two bodies can touch while their relative motion stays below the skin (METHOD 4, stage 2). Conservative:
/// a node that can come within `margin` (reach + skin) of the other outline is in. Both counts are 0 when the bodies stay apart.
void find_arcs(const Model& model, const Outlines& outlines, const std::vector<Box>& boxes, const BodyPair& pair,
               double margin, Arc (&arcs)[2]);

}  // namespace pliant
