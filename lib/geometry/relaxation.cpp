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
// Least distance to the outline, in outline spacings; equilateral triangles would have 0.87.
constexpr double least_depth = 0.7;

// The node distance wanted at a place: `rim` at the outline, growing by `growth` a unit of depth.
struct SizeField {
  const Points& outline;
  double rim, growth;
  double at(const Vec2& x) const { return rim + growth * distance_to_outline(outline, x); }
};

Vec2 centroid(const FieldMesh& mesh, const Triangle& t) {
  return (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]]) / 3;
}

double area(const FieldMesh& mesh, const Triangle& t) {
  return cross(mesh.nodes[t[1]] - mesh.nodes[t[0]], mesh.nodes[t[2]] - mesh.nodes[t[0]]) / 2;
}

// Number of equilateral triangles of the wanted size that fill the mesh's area.
double triangle_demand(const FieldMesh& mesh, const SizeField& size) {
  double demand = 0;
  for (const Triangle& t : mesh.triangles) {
    const double h = size.at(centroid(mesh, t));
    demand += area(mesh, t) / (std::sqrt(3.0) / 4 * h * h);
  }
  return demand;
}

// The growth at which demand meets the number of triangles (bisection); none where the outline is coarse already.
SizeField fitted_size(const FieldMesh& mesh, const Points& outline) {
  SizeField size{outline, perimeter(outline) / mesh.outline_count, 0};
  double slow = 0, fast = 1;
  for (int step = 0; step < 30; ++step) {
    size.growth = (slow + fast) / 2;
    (triangle_demand(mesh, size) > static_cast<double>(mesh.triangles.size()) ? slow : fast) = size.growth;
  }
  size.growth = slow;
  return size;
}

// Area times circumcentre, relative to the triangle's first corner: finite for slivers too.
Vec2 weighted_circumcentre(const Vec2& b, const Vec2& c) {
  return 0.25 *
         Vec2(c.y() * b.squaredNorm() - b.y() * c.squaredNorm(), b.x() * c.squaredNorm() - c.x() * b.squaredNorm());
}

// Where each node would go, [nodes]; meaningless for the outline. In two dimensions, density size^-4 gives that size.
Points optimal_positions(const FieldMesh& mesh, const SizeField& size) {
  Points moment(mesh.nodes.size(), Vec2(0, 0));
  std::vector<double> weight(mesh.nodes.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    const double ratio = size.rim / size.at(centroid(mesh, t)), density = ratio * ratio * ratio * ratio;
    for (int corner = 0; corner < 3; ++corner) {
      const Vec2& x = mesh.nodes[t[corner]];
      const Vec2 b = mesh.nodes[t[(corner + 1) % 3]] - x, c = mesh.nodes[t[(corner + 2) % 3]] - x;
      moment[t[corner]] += density * weighted_circumcentre(b, c);
      weight[t[corner]] += density * cross(b, c) / 2;
    }
  }
  for (std::size_t i = 0; i < moment.size(); ++i) moment[i] = mesh.nodes[i] + moment[i] / weight[i];
  return moment;
}

// A node that would come too near the outline, or cross it at a notch, waits for its neighbours to make room.
bool may_move(const SizeField& size, const Vec2& from, const Vec2& to) {
  const double least = std::min(least_depth * size.rim, distance_to_outline(size.outline, from));
  return is_inside(size.outline, to) && distance_to_outline(size.outline, to) >= least;
}

}  // namespace

void relax_interior(FieldMesh& mesh) {
  const Points outline(mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count);
  mesh.triangles = triangulate_inside(mesh.nodes, mesh.outline_count);
  const SizeField size = fitted_size(mesh, outline);
  double largest_move = size.rim;
  for (int sweep = 0; sweep < max_sweeps && largest_move > settled * size.rim; ++sweep) {
    const Points target = optimal_positions(mesh, size);
    largest_move = 0;
    for (std::size_t i = mesh.outline_count; i < mesh.nodes.size(); ++i) {
      if (!may_move(size, mesh.nodes[i], target[i])) continue;
      largest_move = std::max(largest_move, (target[i] - mesh.nodes[i]).norm());
      mesh.nodes[i] = target[i];
    }
    mesh.triangles = triangulate_inside(mesh.nodes, mesh.outline_count);
  }
}

}  // namespace pliant
