#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "geometry/mesh.hpp"
#include "geometry/polygon.hpp"
#include "shapes.hpp"

namespace pliant {
namespace {

using testing::all_shapes;
using testing::disc;
using testing::error_of;
using testing::outline_of;
using testing::triangle_area;

double least_degrees(const FieldMesh& mesh) {
  double least = std::numbers::pi;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec2 a = mesh.nodes[t[(k + 1) % 3]] - mesh.nodes[t[k]], b = mesh.nodes[t[(k + 2) % 3]] - mesh.nodes[t[k]];
      least = std::min(least, std::atan2(cross(a, b), a.dot(b)));
    }
  return least * 180 / std::numbers::pi;
}

// EXACT: positive triangles whose areas sum to the polygon's, and Euler's count 2 N - 2 - outline: no overlap, no hole.
TEST(FieldMesh, TrianglesCoverThePolygonOnce) {
  for (const ShapeSpec& shape : all_shapes()) {
    SCOPED_TRACE(shape.name);
    const FieldMesh mesh = make_field_mesh(shape);
    double area = 0;
    for (const Triangle& t : mesh.triangles) {
      EXPECT_GT(triangle_area(mesh, t), 0);
      area += triangle_area(mesh, t);
    }
    EXPECT_NEAR(area / polygon_properties(outline_of(mesh)).area, 1, 1e-13);
    EXPECT_EQ(mesh.triangles.size(), 2 * mesh.nodes.size() - 2 - mesh.outline_count);
  }
}

// EXACT: each outline segment belongs to one triangle, each other edge to two, run in opposite senses.
TEST(FieldMesh, EdgesMatch) {
  for (const ShapeSpec& shape : all_shapes()) {
    const FieldMesh mesh = make_field_mesh(shape);
    std::map<std::pair<int, int>, int> uses;
    for (const Triangle& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    for (const auto& [edge, count] : uses) {
      EXPECT_EQ(count, 1);
      const bool outer = edge.second == (edge.first + 1) % mesh.outline_count && edge.first < mesh.outline_count;
      EXPECT_EQ(uses.count({edge.second, edge.first}), outer ? 0U : 1U);
    }
  }
}

// EXACT: the count asked for, for discs and polygons of many sizes.
TEST(FieldMesh, HasTheNodesAskedFor) {
  for (const int nodes : {30, 84, 168, 401, 700}) {
    EXPECT_EQ(make_field_mesh(disc(nodes)).nodes.size(), static_cast<std::size_t>(nodes));
    EXPECT_EQ(make_field_mesh(testing::square(nodes)).nodes.size(), static_cast<std::size_t>(nodes));
    EXPECT_EQ(make_field_mesh(testing::l_shape(nodes)).nodes.size(), static_cast<std::size_t>(nodes));
  }
}

// EXACT: by spacing h, the mean triangle is equilateral of side h: Euler's formula, rounded to whole nodes.
TEST(FieldMesh, SpacingGivesTrianglesOfThatSize) {
  ShapeSpec shape = disc(1, 1);
  shape.nodes.reset();
  shape.spacing = 0.06;
  const FieldMesh mesh = make_field_mesh(shape);
  const double mean = std::numbers::pi / 4 / static_cast<double>(mesh.triangles.size());
  EXPECT_NEAR(mean / (std::sqrt(3.0) / 4 * 0.06 * 0.06), 1, 1.0 / static_cast<double>(mesh.triangles.size()));
}

// Quality that time step and accuracy rest on. EXACT: the bounds are requirements, not measurements: 25 degrees, and
// interior nodes 0.6 spacings off the outline.
TEST(FieldMesh, HasNoSliversAndKeepsOffTheOutline) {
  for (const ShapeSpec& shape : all_shapes()) {
    SCOPED_TRACE(shape.name);
    const FieldMesh mesh = make_field_mesh(shape);
    const Points outline = outline_of(mesh);
    EXPECT_GT(least_degrees(mesh), 25);
    for (std::size_t i = outline.size(); i < mesh.nodes.size(); ++i)
      EXPECT_GT(distance_to_outline(outline, mesh.nodes[i]), 0.6 * perimeter(outline) / mesh.outline_count);
  }
}

// EXACT: the same shape gives the same bits.
TEST(FieldMesh, IsDeterministic) {
  const FieldMesh a = make_field_mesh(disc(168)), b = make_field_mesh(disc(168));
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.nodes, b.nodes);
}

// EXACT: a change of units moves nothing but by rounding, which relaxation (settled to 1e-4) may amplify.
TEST(FieldMesh, DoesNotDependOnUnits) {
  const FieldMesh small = make_field_mesh(disc(168, 1e-6)), large = make_field_mesh(disc(168, 1e3));
  for (std::size_t i = 0; i < small.nodes.size(); ++i)
    EXPECT_LT((small.nodes[i] * 1e6 - large.nodes[i] * 1e-3).norm(), 1e-4 * 0.08);
}

// EXACT: no interior nodes are added and the whole polygon is covered.
TEST(RigidMesh, CoversThePolygon) {
  for (const ShapeSpec& shape : all_shapes()) {
    const FieldMesh mesh = make_rigid_mesh(shape);
    EXPECT_EQ(mesh.nodes.size(), static_cast<std::size_t>(mesh.outline_count));
    EXPECT_EQ(mesh.triangles.size(), mesh.nodes.size() - 2);
    double area = 0;
    for (const Triangle& t : mesh.triangles) area += triangle_area(mesh, t);
    EXPECT_NEAR(area / polygon_properties(mesh.nodes).area, 1, 1e-13);
  }
}

// EXACT: messages say what to change.
TEST(FieldMesh, RefusesTooFewNodes) {
  ShapeSpec shape = disc(40);
  shape.outline_nodes = 40;
  EXPECT_NE(error_of([&] { make_field_mesh(shape); }).find("leave none for the interior"), std::string::npos);
}

}  // namespace
}  // namespace pliant
