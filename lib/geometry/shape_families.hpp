#pragma once

#include <map>
#include <string>
#include <vector>

#include "geometry/assembly.hpp"
#include "geometry/mesh.hpp"

namespace pliant {

/// Shapes of at most so many compliant bodies may share a mesh's topology with others, so that their bodies can be
/// computed together.
inline constexpr int sparse_bodies = 2;
/// It pays off when such shapes have so many field nodes together.
inline constexpr int least_sparse_nodes = 1000;

/// A shape's mesh with the topology of its family's.
struct RelatedMesh {
  int family = 0;
  FieldMesh mesh;
};

/// Meshes, by shape, that take the place of the shapes' own: for smooth shapes of few bodies that agree in their
/// numbers of nodes and outline nodes, where there are enough of them; those that the family's mesh would be bad for
/// are left out. None when shapes of few bodies have fewer than `least_nodes` together.
std::map<std::string, RelatedMesh> related_meshes(const Scene& scene, const std::vector<PlacedBody>& bodies,
                                                  int least_nodes = least_sparse_nodes);

}  // namespace pliant
