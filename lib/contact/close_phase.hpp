#pragma once

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

}  // namespace pliant
