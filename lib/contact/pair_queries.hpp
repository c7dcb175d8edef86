#pragma once

#include "contact/contact_pair.hpp"
#include "contact/history.hpp"

namespace pliant {

// What is asked of a contact pair besides its forces.

/// Length of both sides in touch, each pass with weight 1/2, m.
double touching_length(const PairView& view);

/// Places of the nodes within reach and a skin of the present outlines, where a history has none yet: so that slip
/// counts from the first step in touch. One that comes from further off in a single step, which may go up to two skins,
/// has none.
void locate_new_contacts(const PairView& view, ContactHistory& history);

/// What the law remembers of nodes near the other outline when a run starts, as bonds that are whole. Nothing, for most
/// laws.
void start_records(const PairView& view, ContactHistory& history);

/// Whether some node of the contact pair stands inside the other outline.
bool overlaps(const PairView& view);

/// A-priori contact stiffness a node, N/m2 per metre of thickness, of everything that may come in touch before the next
/// search for candidates, added to the entries of the contact pair's nodes as forces have them: half the tributary
/// length times the stiffness, shared by the two segment nodes on the master, but all of the largest that may slide
/// onto one, and times the factor of the node's side.
void add_patch_stiffness(const PairView& view, const double (&factor)[2], std::vector<double>& entries);

}  // namespace pliant
