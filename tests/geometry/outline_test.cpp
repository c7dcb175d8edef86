#include <gtest/gtest.h>

#include <numbers>

#include "geometry/mesh.hpp"
#include "geometry/polygon.hpp"
#include "shapes.hpp"

namespace pliant {
namespace {

using testing::disc;
using testing::error_of;
using testing::polygon;
using testing::square;

void expect_centred_counter_clockwise(const Points& outline, double size) {
  const PolygonProperties p = polygon_properties(outline);
  EXPECT_GT(p.area, 0);
  EXPECT_LT(p.centroid.norm(), 1e-14 * size);  // EXACT: rounding of a sum of about 100 terms
}

// EXACT: the polygon has the area of the circle, to rounding.
TEST(Outline, DiscHasAreaOfCircle) {
  for (const int nodes : {30, 168, 700}) {
    const Points outline = make_outline(disc(nodes, 3e-6));
    EXPECT_NEAR(polygon_properties(outline).area / (std::numbers::pi / 4 * 9e-12), 1, 1e-13);
    expect_centred_counter_clockwise(outline, 3e-6);
  }
}

// EXACT: the polygon has the area of the curve, and its nodes divide it equally: chords of equal arcs, shorter by their
// curvature: (h/r)^2/24, r the least radius, 1/4 for the ellipse.
TEST(Outline, CurvesHaveTheirAreaAndEqualSegments) {
  for (const Points& points : {ellipse(2, 1), fourier_grain(1.5, {0.2, 0.1, 0.05}, 7)}) {
    const double area = polygon_properties(points).area;
    const Points outline = make_outline(testing::curve("curve", points, 168));
    EXPECT_NEAR(polygon_properties(outline).area / area, 1, 1e-13);
    expect_centred_counter_clockwise(outline, 2);
    double shortest = 1e300, longest = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const double length = (outline[(i + 1) % outline.size()] - outline[i]).norm();
      shortest = std::min(shortest, length), longest = std::max(longest, length);
    }
    EXPECT_GT(shortest / longest, 0.98);
  }
}

// RATE of 2: nodes of a finer outline come closer to the ellipse, by the square of their distance, within a fifth.
TEST(Outline, CurvesConverge) {
  const auto distance = [](int nodes) {
    ShapeSpec shape = testing::curve("ellipse", ellipse(2, 1), 168);
    shape.outline_nodes = nodes;
    double worst = 0;
    for (const Vec2& p : make_outline(shape)) worst = std::max(worst, std::abs(std::hypot(p.x() / 1, p.y() / 0.5) - 1));
    return worst;
  };
  EXPECT_NEAR(std::log2(distance(24) / distance(48)), 2, 0.4);
  EXPECT_NEAR(std::log2(distance(48) / distance(96)), 2, 0.4);
}

// EXACT: more outline nodes for a longer outline round the same area.
TEST(Outline, CurvesGetNodesByTheirLength) {
  EXPECT_EQ(make_outline(testing::curve("round", ellipse(1, 1), 168)).size(), 48U);
  const double longer = perimeter(ellipse(2, 1)) / perimeter(ellipse(std::sqrt(2), std::sqrt(2)));
  EXPECT_EQ(make_outline(testing::curve("long", ellipse(2, 1), 168)).size(),
            static_cast<std::size_t>(std::lround(3.7 * longer * std::sqrt(168))));
}

// EXACT: counts by rule, by spacing (pi/0.1 = 31.4) and as given.
TEST(Outline, DiscNodeCounts) {
  EXPECT_EQ(make_outline(disc(168)).size(), 48U);
  ShapeSpec shape = disc(168, 1);
  shape.nodes.reset();
  shape.spacing = 0.1;
  EXPECT_EQ(make_outline(shape).size(), 31U);
  shape.outline_nodes = 52;
  EXPECT_EQ(make_outline(shape).size(), 52U);
}

// EXACT: edges of 2 m in segments of at most 0.3 m: 7 each, all equal, and every corner is kept.
TEST(Outline, PolygonEdgesAreDividedEvenly) {
  ShapeSpec shape = square(100);
  shape.nodes.reset();
  shape.spacing = 0.3;
  const Points outline = make_outline(shape);
  ASSERT_EQ(outline.size(), 28U);
  expect_centred_counter_clockwise(outline, 2);
  for (std::size_t i = 0; i < outline.size(); ++i)
    EXPECT_NEAR((outline[(i + 1) % outline.size()] - outline[i]).norm(), 2.0 / 7, 1e-14);
  EXPECT_NEAR((outline[7] - Vec2(1, -1)).norm(), 0, 1e-14);
}

// EXACT: a spacing that divides the edges is not refined by rounding: 2/0.1 = 20 segments an edge.
TEST(Outline, ExactMultipleIsNotRefined) {
  ShapeSpec shape = square(100);
  shape.nodes.reset();
  shape.spacing = 0.1;
  EXPECT_EQ(make_outline(shape).size(), 80U);
}

// EXACT: the number of outline nodes asked for, and no segment twice as long as another where edges allow it.
TEST(Outline, PolygonWithGivenNumberOfOutlineNodes) {
  ShapeSpec shape = polygon("triangle", {{0, 0}, {3, 0}, {0, 4}}, 200);
  for (const int count : {3, 10, 37, 60}) {
    shape.outline_nodes = count;
    EXPECT_EQ(make_outline(shape).size(), static_cast<std::size_t>(count));
  }
}

// EXACT: messages name the shape and what is wrong.
TEST(Outline, RefusesInvalidShapes) {
  const auto message = [](const ShapeSpec& shape) { return error_of([&] { make_outline(shape); }); };
  EXPECT_NE(message(polygon("bow", {{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 50)).find("cross"), std::string::npos);
  EXPECT_NE(message(polygon("turned", {{0, 0}, {0, 1}, {1, 0}}, 50)).find("clockwise"), std::string::npos);
  EXPECT_NE(message(polygon("line", {{0, 0}, {0, 1}}, 50)).find("at least 3"), std::string::npos);
  EXPECT_NE(message(disc(50, -1)).find("diameter"), std::string::npos);
  ShapeSpec coarse = disc(50);
  coarse.outline_nodes = 5;
  EXPECT_NE(message(coarse).find("at least 6"), std::string::npos);
  ShapeSpec open = disc(50);
  open.nodes.reset();
  EXPECT_NE(message(open).find("give nodes, spacing"), std::string::npos);
}

}  // namespace
}  // namespace pliant
