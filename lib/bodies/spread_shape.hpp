#pragma once

#include "bodies/layouts.hpp"
#include "discretisation/table.hpp"

namespace pliant {

/// Arranges a shape for bodies that are spread over the lanes.
SpreadShape make_spread_shape(const Discretisation& space);

}  // namespace pliant
