#pragma once

#include <vector>

#include "bodies/model.hpp"

namespace pliant {

/// Options of a caller that are no part of a scene.
struct BuildOptions {
  /// Number of nodes from which bodies that would leave lanes of their batches empty are united with those of
  /// shapes of one topology, or vectorised nodewise. The nodes of all such bodies count together; below, the cost of
  /// empty lanes is negligible. 0: always; a large number: never.
  int least_sparse_nodes = pliant::least_sparse_nodes;
  bool unite_topologies = true;  ///< unite shapes of one topology instead of vectorising their bodies nodewise
  std::vector<double> scales;    ///< Body::scale of the grains, in their order; empty: from the scene
};

/// Builds bodies, tables and masses. Throws InputError for errors that the scene reader cannot detect, such as shapes
/// that cannot be meshed.
Model build_model(const Scene& scene, const BuildOptions& options = {});

}  // namespace pliant
