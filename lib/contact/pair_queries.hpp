#pragma once

#include "contact/contact_pair.hpp"
#include "contact/history.hpp"

namespace pliant {

// Queries of a contact pair besides its forces.

/// Length of both sides that penetrates the other, each half pass with weight 1/2, m.
double touching_length(const PairView& view);

/// Sets the surface coordinates of nodes within reach and a skin of the present outlines, if the history has none yet.
/// Slip then counts from the first step in contact. A node that comes from further away in a single step, which may
/// cover up to two skins, gets none.
void locate_new_contacts(const PairView& view, ContactHistory& history);

/// Whether some node of the contact pair is inside the other outline.
bool overlaps(const PairView& view);

/// Adds the a-priori contact stiffness per node, N/m2 per metre of thickness, of everything that may come into contact
/// before the next search. Entries are those of the contact pair's nodes in force buffers. A slave node gets half its
/// tributary length times the stiffness. The two nodes of the master segment share that; a compliant master's node gets
/// at least all of the largest slave that may slide onto it. All is multiplied by the factor of the node's side.
void add_patch_stiffness(const PairView& view, const double (&factor)[2], LinedNumbers& entries);

}  // namespace pliant
