#include "geometry/triangulate.hpp"

#include <gtest/gtest.h>

#include "core/errors.hpp"

namespace pliant {
namespace {

std::string triangulation_refusal(const Points& points, int outline_count) {
  try {
    triangulate_inside(points, outline_count);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// EXACT: triangles are two fewer than corners, and two more for each point inside; 2 x 2 less the notch of 1.5.
TEST(Triangulate, CoversTheInside) {
  const Points bent{{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}, {0.5, 0.4}, {1.5, 0.6}};
  const std::vector<Triangle> triangles = triangulate_inside(bent, 5);
  double covered = 0;
  for (const Triangle& t : triangles) covered += 0.5 * cross(bent[t[1]] - bent[t[0]], bent[t[2]] - bent[t[0]]);
  EXPECT_EQ(triangles.size(), 3u + 2 * 2);
  EXPECT_NEAR(covered, 2.5, 1e-15);
}

// EXACT. What touches splits an edge in two: the inside would be told from the outside by chance.
TEST(Triangulate, PointsOnTheOutlineAreRefused) {
  const Points touching{{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}};
  EXPECT_NE(triangulation_refusal(touching, 5).find("a point lies on the outline's edge from point 1 to 2"),
            std::string::npos);
  const Points on_a_side{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 0.5}};
  EXPECT_NE(triangulation_refusal(on_a_side, 4).find("a point lies on the outline's edge from point 2 to 3"),
            std::string::npos);
}

TEST(Triangulate, CrossingAndCoincidingAreRefused) {
  EXPECT_NE(triangulation_refusal({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 4).find("crosses itself"), std::string::npos);
  EXPECT_NE(triangulation_refusal({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 0}}, 4).find("5 points, only 4"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
