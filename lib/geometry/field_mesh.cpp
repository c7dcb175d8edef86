#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/errors.hpp"
#include "geometry/mesh.hpp"
#include "geometry/outline_search.hpp"
#include "geometry/polygon.hpp"
#include "geometry/relaxation.hpp"
#include "geometry/shape_outline.hpp"
#include "geometry/triangulate.hpp"

namespace pliant {
namespace {

struct Seed {
  Vec2 position;
  double depth;  // distance to the outline, by which they are sorted
};

// Points of a hexagonal lattice inside the outline, deeper than the height of an equilateral triangle. The odd offset
// keeps the lattice from being symmetric to the outline: points then enter one by one as the spacing shrinks, not a
// whole ring at a time.
std::vector<Seed> hexagonal_seeds(const Points& outline, const OutlineSearch& search, double spacing) {
  Vec2 low = outline[0], high = outline[0];
  for (const Vec2& p : outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
  std::vector<Seed> seeds;
  const double row_height = std::sqrt(3.0) / 2 * spacing;
  const int rows = static_cast<int>((high.y() - low.y()) / row_height) + 1;
  const int columns = static_cast<int>((high.x() - low.x()) / spacing) + 2;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const Vec2 p = low + Vec2((column - 0.3 + 0.5 * (row % 2)) * spacing, (row + 0.43) * row_height);
      if (!search.is_inside(p)) continue;
      if (search.distance(p, 2 * row_height) > row_height) seeds.push_back({p, 0});
    }
  return seeds;
}

// Exactly `count` seeds: the coarsest lattice with at least as many, without those nearest to the outline.
Points interior_seeds(const Points& outline, int count) {
  const double area = polygon_properties(outline).area;
  const OutlineSearch search(outline);
  double fine = std::sqrt(area / count) / 8, coarse = 2 * std::sqrt(area / count);
  for (int step = 0; step < 30; ++step) {
    const double middle = (fine + coarse) / 2;
    (static_cast<int>(hexagonal_seeds(outline, search, middle).size()) >= count ? fine : coarse) = middle;
  }
  std::vector<Seed> seeds = hexagonal_seeds(outline, search, fine);
  if (static_cast<int>(seeds.size()) < count)
    throw InputError(
        fmt::format("mesh: no room for {} interior nodes beside {} outline nodes; the shape is too thin for "
                    "this number of nodes",
                    count, outline.size()));
  for (Seed& seed : seeds) seed.depth = search.distance(seed.position);
  std::sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) {
    return std::tuple(-a.depth, a.position.x(), a.position.y()) < std::tuple(-b.depth, b.position.x(), b.position.y());
  });
  Points positions;
  for (int i = 0; i < count; ++i) positions.push_back(seeds[i].position);
  return positions;
}

}  // namespace

FieldMesh make_field_mesh(const ShapeSpec& shape) {
  FieldMesh mesh;
  mesh.nodes = make_outline(shape);
  mesh.outline_count = static_cast<int>(mesh.nodes.size());
  const Points interior = interior_seeds(mesh.nodes, field_node_count(shape, mesh.nodes) - mesh.outline_count);
  mesh.nodes.insert(mesh.nodes.end(), interior.begin(), interior.end());
  relax_interior(mesh);
  return mesh;
}

FieldMesh make_rigid_mesh(const ShapeSpec& shape) {
  FieldMesh mesh;
  mesh.nodes = make_outline(shape);
  mesh.outline_count = static_cast<int>(mesh.nodes.size());
  mesh.triangles = triangulate_inside(mesh.nodes, mesh.outline_count);
  return mesh;
}

}  // namespace pliant
