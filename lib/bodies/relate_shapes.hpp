#pragma once

#include <map>
#include <string>

#include "geometry/mesh.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Batches of at most so many bodies leave their lanes empty: a spread body costs 0.6 of a batch of eight at 1,000 nodes and 0.5 at 4,000, and
/// threads can share it.
inline constexpr int sparse_bodies = 2;

/// A shape's mesh with the topology of its family's.
struct RelatedMesh {
  int family = 0;
  FieldMesh mesh;
};

/// Meshes for smooth shapes of few bodies that agree in their numbers of nodes and outline nodes, where there are enough of them to fill lanes;
/// those that the family's mesh would be bad for are left out. `bodies`: how many each shape has.
std::map<std::string, RelatedMesh> relate_shapes(const Scene& scene, const std::map<std::string, int>& bodies);

}  // namespace pliant
