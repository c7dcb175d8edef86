#include "discretisation/inner_paths.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace pliant {
namespace {

/// A slit between two prongs: outer corners (0, 0) to (9, 10), the slit from x = 4 to 5 down to y = 3.
Points slit() { return {{0, 0}, {9, 0}, {9, 10}, {5, 10}, {5, 3}, {4, 3}, {4, 10}, {0, 10}}; }

/// Each edge in so many pieces, as outlines of bodies are.
Points divided(const Points& corners, int pieces) {
  Points outline;
  for (std::size_t k = 0; k < corners.size(); ++k)
    for (int n = 0; n < pieces; ++n)
      outline.push_back(corners[k] + double(n) / pieces * (corners[(k + 1) % corners.size()] - corners[k]));
  return outline;
}

Vec2 way(const InnerPaths& paths, const Vec2& from, const Vec2& to) {
  return paths.way(from, paths.triangle_at(from), to, paths.triangle_at(to));
}

struct Known {
  Vec2 from, to;
  double length;
  Vec2 first;  ///< where the first leg ends
};

std::vector<Known> known() {
  const double down = std::hypot(1, 2);
  return {{{1, 1}, {8, 1}, 7, {8, 1}},                           // nothing in between
          {{1, 1}, {4, 3}, std::hypot(3, 2), {4, 3}},            // to a corner
          {{4, 10}, {4, 3}, 7, {4, 3}},                          // along a face
          {{4, 10}, {4, 1}, 9, {4, 1}},                          // on along it, past a corner
          {{3, 5}, {6, 5}, 2 * down + 1, {4, 3}},                // around both corners
          {{4, 5}, {5, 5}, 5, {4, 3}},                           // from face to face
          {{4, 10}, {5, 10}, 15, {4, 3}},                        // from tip to tip, in line with both
          {{3, 10}, {6, 10}, 2 * std::hypot(1, 7) + 1, {4, 3}},  // the same from beside them
          {{2, 3}, {7, 3}, 5, {7, 3}},                           // touches the slit's bottom
          {{3, 5}, {7, 3}, down + 3, {4, 3}},                    // runs along the bottom
          {{4, 3}, {5, 5}, 3, {5, 3}},                           // begins at a corner
          {{3, 3.5}, {5, 2.5}, std::hypot(2, 1), {5, 2.5}}};     // touches a corner in passing
}

// EXACT: paths known by hand, moved and turned, with outlines of corners alone or of many nodes. Rounding of lengths of
// up to 20: 1e-13; of directions where a path only touches the outline, the same.
TEST(InnerPaths, BendAtReEntrantCorners) {
  for (const int pieces : {1, 3, 7})
    for (const double angle : {0.0, 0.3, std::numbers::pi / 2, 2.0})
      for (const Vec2& shift : {Vec2(0, 0), Vec2(-4.5, -4.1)}) {
        const Eigen::Rotation2Dd turn(angle);
        const auto placed = [&](const Vec2& x) { return Vec2(turn * (x + shift)); };
        Points outline = divided(slit(), pieces);
        for (Vec2& x : outline) x = placed(x);
        const InnerPaths paths(outline);
        EXPECT_FALSE(paths.convex());
        for (const Known& path : known()) {
          const Vec2 from = placed(path.from), to = placed(path.to), first = placed(path.first);
          const Vec2 found = way(paths, from, to), back = way(paths, to, from);
          EXPECT_NEAR(found.norm(), path.length, 1e-12) << path.from.transpose() << " to " << path.to.transpose();
          EXPECT_NEAR(back.norm(), path.length, 1e-12) << path.from.transpose() << " to " << path.to.transpose();
          EXPECT_LT((found.normalized() - (first - from).normalized()).norm(), 1e-12)
              << path.from.transpose() << " to " << path.to.transpose();
        }
      }
}

// EXACT: the vector itself, to the last bit, where one end sees the other.
TEST(InnerPaths, AreStraightInSight) {
  const InnerPaths paths(slit());
  const Vec2 from(1.1, 0.3), to(7.7, 2.1);
  EXPECT_EQ(way(paths, from, to), Vec2(to - from));
  EXPECT_EQ(way(paths, from, from), Vec2(0, 0));
}

// EXACT: of an outline that is convex but for rounding, and of one with a dent of 1e-6 rad.
TEST(InnerPaths, TellConvexFromConcave) {
  const Eigen::Rotation2Dd turn(0.4);
  Points square = divided({{0, 0}, {7, 0}, {7, 7}, {0, 7}}, 11);
  for (Vec2& x : square) x = turn * x;
  EXPECT_TRUE(InnerPaths(square).convex());
  square[5] += turn * Vec2(0, 1e-6);
  EXPECT_FALSE(InnerPaths(square).convex());
}

// EXACT: the gradient of the distance by its near end is minus the direction of the first leg. Central differences of
// step d, of lengths down to 1: d^2/6 and 1e-15/d, 1e-10 together at 1e-5.
TEST(InnerPaths, DirectionIsTheGradientOfTheDistance) {
  const InnerPaths paths(divided(slit(), 3));
  const double d = 1e-5;
  for (const auto& [from, to] :
       {std::pair(Vec2(3, 5), Vec2(6, 5.5)), {Vec2(2, 8), Vec2(5.5, 4)}, {Vec2(3, 2), Vec2(7, 7)}})
    for (int axis = 0; axis < 2; ++axis) {
      const Vec2 step = d * Vec2::Unit(axis);
      const double slope = (way(paths, from + step, to).norm() - way(paths, from - step, to).norm()) / (2 * d);
      EXPECT_NEAR(slope, -way(paths, from, to).normalized()[axis], 1e-9);
    }
}

}  // namespace
}  // namespace pliant
