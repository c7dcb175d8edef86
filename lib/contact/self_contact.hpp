#pragma once

#include <vector>

#include "contact/master_window.hpp"

namespace pliant {

/// Appends contact pairs of a closed body with itself: each of two consecutive nodes and the segments that they may
/// touch while its parts move by less than the skin against each other. Segments of the two and two more on either side
/// are left out: they are always near. Further ones need no rule, as a node stands beside a segment only where the
/// outline between has turned by half a circle, or nearly. The nodes are slaves of one pass, with the weight 1/2: where
/// two parts meet, both have nodes. `of_body`: what all contact pairs have in common.
void find_self_pairs(const Model& model, const OutlineField& outlines, const ContactPair& of_body, double margin,
                     double skin, std::vector<ContactPair>& contact_pairs, MasterWindow& scratch);

}  // namespace pliant
