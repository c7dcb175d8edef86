#include "geometry/polygon.hpp"

#include <gtest/gtest.h>

#include "geometry/mesh.hpp"

namespace pliant {
namespace {

// EXACT: a rectangle a x b far from the origin; polar moment a b (a^2 + b^2)/12. Its corners are rounded
// to 1e-16 x 1 m, 1e-10 of its sides.
TEST(Polygon, PropertiesOfRectangleFarAway) {
  const double a = 2e-6, b = 1e-6;
  const PolygonProperties p = polygon_properties({{1, 1}, {1 + a, 1}, {1 + a, 1 + b}, {1, 1 + b}});
  EXPECT_NEAR(p.area / (a * b), 1, 1e-9);
  EXPECT_NEAR(p.centroid.x(), 1 + a / 2, 1e-15);
  EXPECT_NEAR(p.centroid.y(), 1 + b / 2, 1e-15);
  EXPECT_NEAR(p.polar_moment / (a * b * (a * a + b * b) / 12), 1, 1e-9);
}

// EXACT: an L of three unit squares about its centroid (5/6, 5/6): by the parallel axis theorem,
// 3 x 1/6 + (2 x (1/3)^2 + 2 x (1/3)^2 + 2 x (2/3)^2) = 0.5 + 12/9.
TEST(Polygon, PropertiesOfConcavePolygon) {
  const PolygonProperties p = polygon_properties({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}});
  EXPECT_NEAR(p.area, 3, 1e-15);
  EXPECT_NEAR(p.centroid.x(), 5.0 / 6, 1e-15);
  EXPECT_NEAR(p.centroid.y(), 5.0 / 6, 1e-15);
  EXPECT_NEAR(p.polar_moment, 0.5 + 12.0 / 9, 1e-14);
}

// EXACT: orientation is the sign of the area.
TEST(Polygon, ClockwiseAreaIsNegative) { EXPECT_EQ(polygon_properties({{0, 0}, {0, 1}, {1, 0}}).area, -0.5); }

// EXACT: distances to an edge, to a corner and at a notch.
TEST(Polygon, InsideAndDistance) {
  const Points l{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  EXPECT_TRUE(is_inside(l, {0.5, 1.5}));
  EXPECT_FALSE(is_inside(l, {1.5, 1.5}));
  EXPECT_DOUBLE_EQ(distance_to_outline(l, {1.5, 0.75}), 0.25);
  EXPECT_DOUBLE_EQ(distance_to_outline(l, {3, 2}), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(perimeter(l), 8);
}

}  // namespace
}  // namespace pliant
