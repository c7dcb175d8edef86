#include "geometry/same_topology_mesh.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "geometry/curves.hpp"

namespace pliant {
namespace {

Points grain_outline(const std::vector<double>& descriptors, int seed) {
  ShapeSpec shape;
  shape.name = "grain";
  shape.kind = ShapeKind::curve;
  shape.points = fourier_grain(1, descriptors, seed);
  shape.nodes = 168;
  shape.outline_nodes = 50;
  return make_outline(shape);
}

double degrees(const FieldMesh& mesh) { return least_angle(mesh) * 180 / std::numbers::pi; }

// EXACT: the same triangles around any outline, all of positive area, which sum to the polygon's.
TEST(SharedTopologyMesh, KeepsItsTrianglesAndCoversThePolygon) {
  const MeshTemplate of_family(168, 50);
  std::vector<Triangle> triangles;
  for (int seed = 1; seed <= 6; ++seed) {
    const Points outline = grain_outline({0.1, 0.04, 0.02}, seed);
    const auto mesh = of_family.mapped(outline);
    ASSERT_TRUE(mesh.has_value()) << seed;
    EXPECT_EQ(mesh->nodes.size(), 168U);
    for (std::size_t k = 0; k < outline.size(); ++k) EXPECT_EQ(mesh->nodes[k], outline[k]);
    if (seed == 1) triangles = mesh->triangles;
    EXPECT_EQ(mesh->triangles, triangles);
    double area = 0;
    for (const Triangle& t : mesh->triangles)
      area += cross(mesh->nodes[t[1]] - mesh->nodes[t[0]], mesh->nodes[t[2]] - mesh->nodes[t[0]]) / 2;
    EXPECT_NEAR(area / polygon_properties(outline).area, 1, 1e-13);
    EXPECT_GT(degrees(*mesh), 20) << "EXACT: the limit";
  }
}

// EXACT: a disc of another size and place is its template, moved; 1e-3 of a degree: the last steps of the descent.
TEST(SharedTopologyMesh, OfADiscIsTheTemplate) {
  ShapeSpec disc;
  disc.name = "disc";
  disc.diameter = 3;
  disc.nodes = 168;
  disc.outline_nodes = 50;
  const auto mesh = MeshTemplate(168, 50).mapped(make_outline(disc));
  ASSERT_TRUE(mesh.has_value());
  const FieldMesh own = make_field_mesh(disc);
  for (std::size_t i = 0; i < own.nodes.size(); ++i) EXPECT_LT((mesh->nodes[i] - own.nodes[i]).norm(), 1e-12);
}

// FROZEN: what smoothing is for; the harmonic map alone has angles of 28.6 and 22.0 degrees there, and under 20.
TEST(SharedTopologyMesh, IsSmoothed) {
  const MeshTemplate of_family(168, 50);
  EXPECT_NEAR(degrees(of_family.mapped(grain_outline({0.1}, 3)).value()), 29.9, 0.5);
  EXPECT_NEAR(degrees(of_family.mapped(grain_outline({0.2}, 3)).value()), 25.7, 0.5);
  EXPECT_NEAR(degrees(of_family.mapped(grain_outline({0.1, 0.05, 0.03}, 3)).value()), 24.3, 0.5);
}

// EXACT: no mesh is better than a bad one.
TEST(SharedTopologyMesh, IsRefusedWhereItWouldBeBad) {
  const MeshTemplate of_family(168, 50);
  EXPECT_FALSE(of_family.mapped(grain_outline({0.2, 0.1, 0.08, 0.05}, 1)).has_value());
  Points crossing = grain_outline({0.1}, 1);
  std::swap(crossing[3], crossing[30]);
  EXPECT_FALSE(of_family.mapped(crossing).has_value());
}

}  // namespace
}  // namespace pliant
