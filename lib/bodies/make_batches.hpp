#pragma once

#include "bodies/model.hpp"

namespace pliant {

/// Gives the bodies of all groups their batches, lanes and regions: see BuildOptions::least_sparse_nodes.
void make_batches(Model& model, int least_sparse_nodes);

}  // namespace pliant
