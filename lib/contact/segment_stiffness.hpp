#pragma once

#include "contact/contact_pair.hpp"

namespace pliant {

/// As add_patch_stiffness (pair_queries.hpp), for contact integrated over segments. Lengths are weighted by hat
/// functions. A slave node gets their integral over all that may touch, a node of the master that of the slave's length
/// in front of its own segments. Lumped at nodes, both are more than the integrals of products of hat functions.
void add_integrated_stiffness(const PairView& view, const double (&factor)[2], LinedNumbers& entries);

}  // namespace pliant
