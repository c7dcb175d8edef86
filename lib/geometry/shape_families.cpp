#include "geometry/shape_families.hpp"

#include "core/located.hpp"
#include "geometry/same_topology_mesh.hpp"
#include "geometry/shape_outline.hpp"

namespace pliant {
namespace {

/// Number of shapes from which they cost less united than one by one.
constexpr std::size_t least_family = 3;

/// Shape of few bodies.
struct Relative {
  const ShapeSpec* shape;
  Points outline;
  int nodes;   ///< field nodes
  int bodies;  ///< bodies of this shape
};

std::vector<Relative> sparse_shapes(const Scene& scene, const std::vector<PlacedBody>& bodies) {
  std::map<std::string, int> count;
  for (const PlacedBody& body : bodies)
    if (!body.wall && body.kind == BodyKind::compliant) ++count[scene.shapes[body.shape].name];
  std::vector<Relative> result;
  for (const auto& [name, number] : count) {
    if (number > sparse_bodies) continue;
    const ShapeSpec& shape = scene.shape(name);
    located(shape.where, [&] {
      const Points outline = make_outline(shape);
      result.push_back({&shape, outline, field_node_count(shape, outline), number});
    });
  }
  return result;
}

}  // namespace

std::map<std::string, SharedTopologyMesh> same_topology_meshes(const Scene& scene,
                                                               const std::vector<PlacedBody>& bodies, int least_nodes) {
  int nodes = 0;
  std::map<std::pair<int, int>, std::vector<Relative>> relatives;  // by numbers of nodes and outline nodes
  for (const Relative& one : sparse_shapes(scene, bodies)) {
    nodes += one.bodies * one.nodes;
    if (one.shape->kind != ShapeKind::polygon)
      relatives[{one.nodes, static_cast<int>(one.outline.size())}].push_back(one);
  }
  std::map<std::string, SharedTopologyMesh> result;
  if (nodes < least_nodes) return result;
  int family = 0;
  for (const auto& [numbers, shapes] : relatives) {
    if (shapes.size() < least_family) continue;
    const MeshTemplate of_family(numbers.first, numbers.second);
    for (const Relative& relative : shapes)
      if (const auto mesh = of_family.mapped(relative.outline)) result[relative.shape->name] = {family, *mesh};
    ++family;
  }
  return result;
}

}  // namespace pliant
