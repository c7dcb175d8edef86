#include "geometry/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/outline_search.hpp"
#include "geometry/polygon.hpp"
#include "geometry/triangulate.hpp"

namespace pliant {
namespace {

// Stops when no node moves by more than this share of the spacing, far less than changes a triangle's quality.
constexpr double settled_move = 1e-4;
constexpr int max_sweeps = 300;
// Few sweeps improve a large mesh near its outline, and thousands would be needed for its interior. With 30 of them the
// least angle of 50,000 nodes in a disc or a block is 32 degrees, as it is with 60.
constexpr int min_sweeps = 30;
constexpr double node_sweeps = 1.5e6;  // nodes times sweeps, from 5,000 nodes on
// Least distance to the outline, in outline spacings; equilateral triangles would have 0.87.
constexpr double least_depth = 0.7;

// Wanted node distance at a position: `rim` at the outline, growing by `growth` per unit of depth.
struct SizeField {
  const OutlineSearch& outline;
  double rim, growth;
  double at(const Vec2& x) const { return growth == 0 ? rim : rim + growth * outline.distance(x); }
};

Vec2 centroid(const FieldMesh& mesh, const Triangle& t) {
  return (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]]) / 3;
}

double area(const FieldMesh& mesh, const Triangle& t) {
  return cross(mesh.nodes[t[1]] - mesh.nodes[t[0]], mesh.nodes[t[2]] - mesh.nodes[t[0]]) / 2;
}

// Number of equilateral triangles of the wanted size that fill the mesh's area; `depth`: of each triangle's centroid.
double triangle_demand(const FieldMesh& mesh, const SizeField& size, const std::vector<double>& depth) {
  double demand = 0;
  for (std::size_t t = 0; t < depth.size(); ++t) {
    const double h = size.rim + size.growth * depth[t];
    demand += area(mesh, mesh.triangles[t]) / (std::sqrt(3.0) / 4 * h * h);
  }
  return demand;
}

// Size field with the growth at which demand equals the number of triangles (bisection); none if the outline is coarse
// already.
SizeField fitted_size(const FieldMesh& mesh, const OutlineSearch& outline, double rim) {
  SizeField size{outline, rim, 0};
  std::vector<double> depth;
  for (const Triangle& t : mesh.triangles) depth.push_back(outline.distance(centroid(mesh, t)));
  double slow = 0, fast = 1;
  for (int step = 0; step < 30; ++step) {
    size.growth = (slow + fast) / 2;
    (triangle_demand(mesh, size, depth) > static_cast<double>(mesh.triangles.size()) ? slow : fast) = size.growth;
  }
  size.growth = slow;
  return size;
}

// Area times circumcentre, relative to the triangle's first corner: finite for slivers too.
Vec2 weighted_circumcentre(const Vec2& b, const Vec2& c) {
  return 0.25 *
         Vec2(c.y() * b.squaredNorm() - b.y() * c.squaredNorm(), b.x() * c.squaredNorm() - c.x() * b.squaredNorm());
}

// [nodes] target of each node; meaningless for the outline. In two dimensions, density size^-4 gives that size.
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

// A node that would come too near the outline, or cross it at a notch, waits until its neighbours make room.
bool may_move(const SizeField& size, const Vec2& from, const Vec2& to) {
  const double enough = least_depth * size.rim, depth = size.outline.distance(to, enough);
  return size.outline.is_inside(to) && (depth >= enough || depth >= size.outline.distance(from, enough));
}

}  // namespace

void relax_interior(FieldMesh& mesh) {
  const Points outline(mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count);
  mesh.triangles = triangulate_inside(mesh.nodes, mesh.outline_count);
  const OutlineSearch search(outline);
  const SizeField size = fitted_size(mesh, search, perimeter(outline) / mesh.outline_count);
  double largest_move = size.rim;
  const double sweeps =
      std::clamp<double>(node_sweeps / static_cast<double>(mesh.nodes.size()), min_sweeps, max_sweeps);
  for (int sweep = 0; sweep < sweeps && largest_move > settled_move * size.rim; ++sweep) {
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
