#include "geometry/triangulate.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <set>

#include "core/errors.hpp"

namespace pliant {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;

Delaunay constrained_delaunay(const Points& points, int outline_count) {
  Delaunay delaunay;
  std::vector<Delaunay::Vertex_handle> vertices;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto hint = vertices.empty() ? Delaunay::Face_handle() : vertices.back()->face();
    vertices.push_back(delaunay.insert({points[i].x(), points[i].y()}, hint));
    vertices.back()->info() = static_cast<int>(i);
  }
  if (delaunay.number_of_vertices() != points.size())
    throw InputError(
        fmt::format("mesh: {} points, only {} of them distinct", points.size(), delaunay.number_of_vertices()));
  for (int i = 0; i < outline_count; ++i) {
    const int next = (i + 1) % outline_count;
    delaunay.insert_constraint(vertices[i], vertices[next]);
    if (!delaunay.is_edge(vertices[i], vertices[next]))  // a point on the edge splits it
      throw InputError(fmt::format("mesh: a point lies on the outline's edge from point {} to {}", i + 1, next + 1));
  }
  return delaunay;
}

// Faces reached from infinity without crossing the outline.
std::set<Delaunay::Face_handle> outer_faces(const Delaunay& delaunay) {
  std::set<Delaunay::Face_handle> outside{delaunay.infinite_face()};
  std::vector<Delaunay::Face_handle> open{delaunay.infinite_face()};
  while (!open.empty()) {
    const auto face = open.back();
    open.pop_back();
    for (int edge = 0; edge < 3; ++edge)
      if (!face->is_constrained(edge) && outside.insert(face->neighbor(edge)).second)
        open.push_back(face->neighbor(edge));
  }
  return outside;
}

}  // namespace

std::vector<Triangle> triangulate_inside(const Points& points, int outline_count) try {
  const Delaunay delaunay = constrained_delaunay(points, outline_count);
  const auto outside = outer_faces(delaunay);
  std::vector<Triangle> triangles;
  for (const auto face : delaunay.finite_face_handles()) {
    if (outside.contains(face)) continue;
    const Triangle t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
    if (!(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]) > 0))
      throw InputError(
          fmt::format("mesh: the triangle of nodes {}, {}, {} has no area; change the node spacing", t[0], t[1], t[2]));
    triangles.push_back(t);
  }
  return triangles;
} catch (const Delaunay::Intersection_of_constraints_exception&) {
  throw InputError("mesh: the outline crosses itself; correct the polygon's points");
}

}  // namespace pliant
