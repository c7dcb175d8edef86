#pragma once

#include <vector>

#include "contact/master_window.hpp"

namespace pliant {

/// Appends patches of a closed body with itself: each of two consecutive nodes and the segments that they may touch
/// while its parts move by less than the skin against each other. Segments of the two and two more on either side are
/// left out: they are always near. Further ones need no rule, as a node stands beside a segment only where the outline
/// between has turned by half a circle, or nearly. The nodes are slaves of one pass, with the weight 1/2: where two
/// parts meet, both have nodes. `of_body`: what all patches have in common.
void find_self_patches(const Model& model, const OutlineField& outlines, const Patch& of_body, double margin,
                       double skin, std::vector<Patch>& patches, MasterWindow& scratch);

}  // namespace pliant
