#pragma once

#include <map>
#include <string>
#include <vector>

#include "geometry/assembly.hpp"
#include "geometry/mesh.hpp"

namespace pliant {

/// Largest number of compliant bodies of a shape that may share a mesh's topology with others, so that their bodies can
/// be computed together.
inline constexpr int sparse_bodies = 2;
/// Number of field nodes of such shapes together from which this is faster.
inline constexpr int least_sparse_nodes = 1000;

/// Mesh of a shape with the topology of its family.
struct SharedTopologyMesh {
  int family = 0;
  FieldMesh mesh;
};

/// Meshes, by shape, that replace the shapes' own: for smooth shapes of few bodies that agree in their numbers of nodes
/// and outline nodes, if there are enough of them. Shapes for which the family's mesh would be bad are left out. There
/// are none if shapes of few bodies have fewer than `least_nodes` together.
std::map<std::string, SharedTopologyMesh> same_topology_meshes(const Scene& scene,
                                                               const std::vector<PlacedBody>& bodies,
                                                               int least_nodes = least_sparse_nodes);

}  // namespace pliant
