// The part of a polygon in a rectangle, against a count of points.
#include "geometry/clip.hpp"

#include <gtest/gtest.h>

#include "geometry/mesh.hpp"
#include "geometry/polygon.hpp"
#include "support/scenes.hpp"

namespace pliant::testing {
namespace {

double area_of(const Points& polygon) { return polygon_properties(polygon).area; }

TEST(Clip, a_square) {
  const Points square{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  EXPECT_NEAR(area_of(clipped(square, {1, 1}, {3, 3})), 1, 1e-15) << "EXACT: a corner";
  EXPECT_NEAR(area_of(clipped(square, {-1, 0.5}, {3, 0.75})), 0.5, 1e-15) << "EXACT: a band";
  EXPECT_NEAR(area_of(clipped(square, {-1, -1}, {3, 3})), 4, 1e-15) << "EXACT: all";
  EXPECT_TRUE(clipped(square, {3, 0}, {4, 1}).empty()) << "EXACT: none";
}

/// A comb whose teeth the rectangle cuts off from one another.
TEST(Clip, a_concave_polygon_that_falls_asunder) {
  const Points comb{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 0.5}, {1, 0.5}, {1, 2}, {0, 2}};
  EXPECT_NEAR(area_of(clipped(comb, {-1, 1}, {4, 1.5})), 1, 1e-15) << "EXACT: two teeth of 1 x 0.5";
}

TEST(Clip, random_stars_and_their_parts) {
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const Points star = random_star(random, 5 + random.below(20), 0.3);
    const Vec2 cut{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
    double sum = 0;
    for (const Vec2& low : {Vec2(-2, -2), Vec2(cut.x(), -2), Vec2(-2, cut.y()), cut}) {
      const Vec2 high(low.x() < cut.x() ? cut.x() : 2, low.y() < cut.y() ? cut.y() : 2);
      sum += area_of(clipped(star, low, high));
    }
    EXPECT_NEAR(sum, area_of(star), 1e-14) << "EXACT: four parts make the whole";
    // INDEPENDENT: midpoints of a grid of 400 x 400 inside; their number errs by a share of those on the edge.
    int inside = 0;
    const int n = 400;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const Vec2 p = cut + Vec2((i + 0.5) / n * (2 - cut.x()), (j + 0.5) / n * (2 - cut.y()));
        inside += is_inside(star, p);
      }
    const double cell = (2 - cut.x()) * (2 - cut.y()) / (n * n);
    EXPECT_NEAR(area_of(clipped(star, cut, {2, 2})), inside * cell, 0.01)
        << "perimeter 10 at most x cell 0.006 / sqrt(n)";
  }
}

}  // namespace
}  // namespace pliant::testing
