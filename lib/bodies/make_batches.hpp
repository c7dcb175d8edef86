#pragma once

#include "bodies/model.hpp"

namespace pliant {

/// Assigns batches, lanes and regions to the bodies of all groups: see BuildOptions::least_sparse_nodes. Makes all
/// bodies of the model own ones.
void make_batches(Model& model, int least_sparse_nodes);

}  // namespace pliant
