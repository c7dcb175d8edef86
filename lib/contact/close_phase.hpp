#pragma once

#include "contact/contact_pair.hpp"
#include "contact/master_window.hpp"

namespace pliant {

/// Finds the nodes and segments through which a contact pair's two bodies can touch while their relative motion stays
/// below the skin (docs/method.md 4, stage 2), and sets them in the contact pair. Conservative: a node within `margin`
/// (reach + skin) of a segment of the other outline, or within sight below it
/// (compute_pair), is in, and so is the segment. All counts are 0 when the bodies stay apart. Returns the least
/// distance of the two outlines, m; where it is more than `look`, anything between.
double find_arcs(const Model& model, const OutlineField& outlines, ContactPair& contact_pair, double margin,
                 double skin, MasterWindow& scratch, double look = 0);

}  // namespace pliant
