#pragma once

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"

namespace pliant {

/// Largest entry of F - I, in absolute value, over the bodies of materials that hold for small strains only; 0 without
/// such bodies.
double largest_small_strain(const Model& model, const Dofs& position);

}  // namespace pliant
