#pragma once

#include "bodies/layouts.hpp"
#include "discretisation/table.hpp"

namespace pliant {

/// Arranges a shape for bodies that are vectorised over their nodes.
NodewiseShape make_nodewise_shape(const Discretisation& space);

}  // namespace pliant
