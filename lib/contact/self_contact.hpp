#pragma once

#include <vector>

#include "contact/master_window.hpp"

namespace pliant {

/// Appends contact pairs of a closed body with itself. Each has two consecutive nodes and the segments that they may
/// touch while parts of the body move by less than the skin against each other. The segments at both nodes and two more
/// on either side are excluded because they are always near. Other segments need no rule: a node projects onto one only
/// if the outline between them has turned by about half a circle. The nodes are slaves of one half pass with weight
/// 1/2; where two parts meet, both have nodes. `of_body`: members that all these contact pairs share.
void find_self_pairs(const Model& model, const OutlineField& outlines, const ContactPair& of_body, double margin,
                     double skin, std::vector<ContactPair>& contact_pairs, MasterWindow& scratch);

}  // namespace pliant
