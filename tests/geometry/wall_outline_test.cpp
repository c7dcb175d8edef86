#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/mesh.hpp"
#include "shapes.hpp"

namespace pliant {
namespace {

using testing::error_of;

Wall flat(Wall::Solid solid) {
  Wall wall;
  wall.name = "wall";
  wall.solid = solid;
  wall.level = 0.25;
  return wall;
}

Wall capped(Wall::Solid solid) {
  Wall wall = flat(solid);
  wall.asperities =
      Asperities{.diameter = 1, .count = 10, .first = 0.1, .heights = {0, 0.5}, .half_angles = {0.7, 1.0}};
  return wall;
}

// The chain from its first point to the same point one period on.
Points closed_chain(const Wall& wall, double period, double spacing) {
  Points chain = wall_outline(wall, period, spacing);
  const double forward = wall.solid == Wall::Solid::below ? -period : period;
  chain.push_back(chain.front() + Vec2(forward, 0));
  return chain;
}

// EXACT: single-valued over exactly one period, segments no longer than asked (to rounding), normals (ty, -tx) towards
// the grains.
void expect_valid(const Wall& wall, double period, double spacing) {
  const double up = wall.solid == Wall::Solid::below ? 1 : -1;
  const Points chain = closed_chain(wall, period, spacing);
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const Vec2 t = chain[i + 1] - chain[i];
    EXPECT_GT(-t.x() * up, 0);
    EXPECT_LT(t.norm(), spacing * (1 + 1e-8));
    EXPECT_GE(chain[i].x(), 0);
    EXPECT_LT(chain[i].x(), period);
  }
}

TEST(WallOutline, FlatWallsAreDividedEvenly) {
  for (const auto solid : {Wall::Solid::below, Wall::Solid::above}) {
    expect_valid(flat(solid), 8.7, 0.06);
    const Points chain = closed_chain(flat(solid), 8.7, 0.06);
    EXPECT_EQ(chain.size(), 146U);  // EXACT: 8.7/0.06 = 145
    for (const Vec2& p : chain) EXPECT_EQ(p.y(), 0.25);
    EXPECT_NEAR((chain[5] - chain[4]).norm(), 0.06, 1e-14);
  }
}

TEST(WallOutline, CappedWallsAreSingleValuedAndClose) {
  for (const auto solid : {Wall::Solid::below, Wall::Solid::above})
    for (const double spacing : {0.06, 0.3, 2.0}) expect_valid(capped(solid), 15, spacing);
}

// EXACT: every point lies on an asperity's circle within its half angle, or on the line between two arcs' ends.
TEST(WallOutline, PointsLieOnAsperitiesOrBetween) {
  const double period = 15;
  for (const auto solid : {Wall::Solid::below, Wall::Solid::above}) {
    const Wall wall = capped(solid);
    const double up = solid == Wall::Solid::below ? 1 : -1;
    int on_arcs = 0;
    const Points chain = wall_outline(wall, period, 0.06);
    for (const Vec2& p : chain)
      for (int j = 0; j < 10; ++j) {
        Vec2 r = p - Vec2(0.1 + 1.5 * j, 0.25 + up * 0.5 * (j % 2));
        r.x() -= std::round(r.x() / period) * period;
        const double angle = std::atan2(r.x(), up * r.y());
        if (std::abs(angle) < (j % 2 ? 1.0 : 0.7) + 1e-9 && r.norm() < 0.75) {
          EXPECT_NEAR(r.norm(), 0.5, 1e-13);
          ++on_arcs;
        }
      }
    // 5 arcs of 0.7 and 5 of 1.0 rad in segments of at most 0.06: 12 and 17, both ends counted.
    EXPECT_EQ(on_arcs, 5 * (12 + 1) + 5 * (17 + 1));
  }
}

// EXACT: the highest point of an asperity of odd column is its height and radius above the level.
TEST(WallOutline, AsperitiesReachTowardsTheGrains) {
  Wall wall = capped(Wall::Solid::above);
  wall.asperities->half_angles = {0.7};
  const Points chain = wall_outline(wall, 15, 0.01);
  const double lowest =
      std::min_element(chain.begin(), chain.end(), [](auto& a, auto& b) { return a.y() < b.y(); })->y();
  EXPECT_NEAR(lowest, 0.25 - 0.5 - 0.5, 0.5 * 0.01 * 0.01);
}

TEST(WallOutline, RefusesOverlappingAsperities) {
  Wall wall = capped(Wall::Solid::below);
  wall.asperities->count = 25;
  EXPECT_NE(error_of([&] { wall_outline(wall, 15, 0.06); }).find("beyond the start of the next"), std::string::npos);
  wall.asperities->half_angles = {1.6};
  EXPECT_NE(error_of([&] { wall_outline(wall, 15, 0.06); }).find("half angle"), std::string::npos);
}

}  // namespace
}  // namespace pliant
