#include "bodies/relate_shapes.hpp"

#include "geometry/outline.hpp"
#include "geometry/related_mesh.hpp"

namespace pliant {
namespace {

/// United, so many shapes cost less than spread one by one.
constexpr std::size_t least_family = 3;

struct Relative {
  std::string shape;
  Points outline;
};

}  // namespace

std::map<std::string, RelatedMesh> relate_shapes(const Scene& scene, const std::map<std::string, int>& bodies) {
  std::map<std::pair<int, int>, std::vector<Relative>> relatives;  // by numbers of nodes and outline nodes
  for (const auto& [name, count] : bodies) {
    const ShapeSpec& shape = scene.shape(name);
    if (count > sparse_bodies || shape.kind == ShapeKind::polygon) continue;
    const Points outline = make_outline(shape);
    relatives[{field_node_count(shape, outline), static_cast<int>(outline.size())}].push_back({name, outline});
  }
  std::map<std::string, RelatedMesh> result;
  int family = 0;
  for (const auto& [numbers, shapes] : relatives) {
    if (shapes.size() < least_family) continue;
    const MeshTemplate of_family(numbers.first, numbers.second);
    for (const Relative& relative : shapes)
      if (const auto mesh = of_family.mapped(relative.outline)) result[relative.shape] = {family, *mesh};
    ++family;
  }
  return result;
}

}  // namespace pliant
