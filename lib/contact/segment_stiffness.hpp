#pragma once

#include <vector>

#include "contact/contact_pair.hpp"

namespace pliant {

/// As add_patch_stiffness (pair_queries.hpp), of contact integrated over segments. By hat functions: a slave node
/// stands for their integral over all that may touch, and a node of the master for that of the slave's length in front
/// of its own segments. Lumped at nodes both are more than the integrals of products of hat functions.
void add_integrated_stiffness(const PairView& view, const double (&factor)[2], std::vector<double>& entries);

}  // namespace pliant
