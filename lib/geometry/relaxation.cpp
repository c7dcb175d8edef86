#include "geometry/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/polygon.hpp"
#include "geometry/triangulate.hpp"

namespace pliant {
namespace {

// Stops when no node moves by more than this share of the spacing: far below what changes a triangle's quality.
constexpr double settled = 1e-4;
constexpr int max_sweeps = 300;
// Least distance to the outline, in spacings; equilateral triangles would have 0.87.
constexpr double least_depth = 0.7;

// Area times circumcentre, relative to the triangle's first corner: finite for slivers too.
Vec2 weighted_circumcentre(const Vec2& b, const Vec2& c) {
  return 0.25 *
         Vec2(c.y() * b.squaredNorm() - b.y() * c.squaredNorm(), b.x() * c.squaredNorm() - c.x() * b.squaredNorm());
}

// Where each node would go, [nodes]; meaningless for the outline.
Points optimal_positions(const FieldMesh& mesh) {
  Points sum(mesh.nodes.size(), Vec2(0, 0));
  std::vector<double> area(mesh.nodes.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const Vec2& x = mesh.nodes[t[corner]];
      const Vec2 b = mesh.nodes[t[(corner + 1) % 3]] - x, c = mesh.nodes[t[(corner + 2) % 3]] - x;
      sum[t[corner]] += weighted_circumcentre(b, c);
      area[t[corner]] += cross(b, c) / 2;
    }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = mesh.nodes[i] + sum[i] / area[i];
  return sum;
}

}  // namespace

void relax_interior(FieldMesh& mesh) {
  const Points outline(mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count);
  mesh.triangles = triangulate_inside(mesh.nodes, mesh.outline_count);
  const double mean_area = polygon_properties(outline).area / static_cast<double>(mesh.triangles.size());
  const double spacing = std::sqrt(4 / std::sqrt(3.0) * mean_area);
  double largest_move = spacing;
  for (int sweep = 0; sweep < max_sweeps && largest_move > settled * spacing; ++sweep) {
    const Points target = optimal_positions(mesh);
    largest_move = 0;
    for (std::size_t i = mesh.outline_count; i < mesh.nodes.size(); ++i) {
      // A node that would come too near the outline, or cross it at a notch, waits for its neighbours to make room.
      const double least = std::min(least_depth * spacing, distance_to_outline(outline, mesh.nodes[i]));
      if (!is_inside(outline, target[i]) || distance_to_outline(outline, target[i]) < least) continue;
      largest_move = std::max(largest_move, (target[i] - mesh.nodes[i]).norm());
      mesh.nodes[i] = target[i];
    }
    mesh.triangles = triangulate_inside(mesh.nodes, mesh.outline_count);
  }
}

}  // namespace pliant
