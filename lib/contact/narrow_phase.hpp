#pragma once

#include <vector>

#include "contact/contact_pair.hpp"
#include "contact/master_window.hpp"

namespace pliant {

/// Finds the nodes and segments through which both bodies of a contact pair can touch, and sets them in the pair. They
/// are valid while the relative displacement of the bodies stays below the skin (docs/method.md 4, stage 2). The result
/// is conservative: it contains each node within `margin` (reach + skin) of a segment of the other outline, or within
/// the detection depth below it (compute_pair), and that segment. All counts are 0 if the bodies stay apart. Returns
/// the least distance of the two outlines, m; if that exceeds `distance`, any value between the two.
double find_arcs(const Model& model, const OutlineField& outlines, ContactPair& contact_pair, double margin,
                 double skin, MasterWindow& scratch, double distance = 0);

/// Appends contact pairs of a closed body with itself. Each has two consecutive nodes and the segments that they may
/// touch while parts of the body move by less than the skin against each other. The segments at both nodes and two more
/// on either side are excluded because they are always near. Other segments need no rule: a node projects onto one only
/// if the outline between them has turned by about half a circle. The nodes are slaves of one half pass with weight
/// 1/2; where two parts meet, both have nodes. `of_body`: members that all these contact pairs share.
void find_self_pairs(const Model& model, const OutlineField& outlines, const ContactPair& of_body, double margin,
                     double skin, std::vector<ContactPair>& contact_pairs, MasterWindow& scratch);

}  // namespace pliant
