#pragma once

#include "bodies/layouts.hpp"
#include "discretisation/table.hpp"

namespace pliant {

/// Unites the tables of lane_count shapes on meshes of one topology.
SameTopologyShapes unite(const Discretisation* const (&shapes)[lane_count]);

}  // namespace pliant
