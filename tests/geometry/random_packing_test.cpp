#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>

#include "packings.hpp"

namespace pliant {
namespace {

using namespace testing;

/// Round, long, angular and concave ones.
std::vector<ShapeSpec> mixed_shapes() {
  ShapeSpec l = polygon("L", {{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}}, 80);
  return {disc(80, 1), curve("egg", ellipse(1.4, 0.7), 80), l,
          curve("pebble", fourier_grain(1, {0.15, 0.1, 0.05}, 3), 80)};
}

void expect_within(const std::vector<Points>& outlines, const Packing& region, bool box) {
  for (const Points& outline : outlines)
    for (const Vec2& p : outline) {
      EXPECT_GE(p.y(), region.bottom);
      EXPECT_LE(p.y(), region.top);
      if (!box) continue;
      EXPECT_GE(p.x(), region.left);
      EXPECT_LE(p.x(), region.right);
    }
}

// EXACT: no two outlines share a point, by a test of all pairs that the packing does not use; all lie in the region;
// each grain has its shape and size. A strip, and a box without a period.
TEST(RandomPacking, IsFreeOfOverlap) {
  for (const bool box : {false, true}) {
    Scene scene = packing_scene(PackingKind::random, mixed_shapes(), 0.7, 80);
    if (box) scene.period.reset();
    const Packed packed = pack(scene);
    const std::vector<Points> outlines = outlines_of(scene, packed);
    EXPECT_EQ(overlapping_pairs(outlines, scene.period), 0);
    expect_within(outlines, scene.grains[0].packing, box);
    for (int shape = 0; shape < 4; ++shape)
      EXPECT_EQ(std::count_if(packed.grains.begin(), packed.grains.end(), [&](auto& g) { return g.shape == shape; }),
                20);
    double squares = 0;
    for (const Placement& grain : packed.grains) squares += grain.scale * grain.scale / 80;
    EXPECT_NEAR(squares, 1.03, 1e-3) << "mean of size^2: 1 + 0.6^2/12, quantiles: 1/80^2 off";
  }
}

Wall capped_wall(const std::string& name, Wall::Solid solid, double level) {
  Wall wall;
  wall.name = name;
  wall.solid = solid;
  wall.level = level;
  wall.asperities = Asperities{0.9, 7, 0.3, {0.1, -0.1, 0.2}, {0.8, 1.2}};
  return wall;
}

/// A wall's solid over three periods, to a depth of 2, with points on asperities ten times finer than the packing's.
Points solid_of(const Wall& wall, double period) {
  Points line = wall_outline(wall, period, wall.asperities->diameter / 200), solid;
  const bool below = wall.solid == Wall::Solid::below;
  if (below) std::reverse(line.begin(), line.end());
  for (const double turn : {-1.0, 0.0, 1.0})
    for (const Vec2& p : line) solid.emplace_back(p.x() + turn * period, p.y());
  const double depth = wall.level + (below ? -2 : 2);
  solid.emplace_back(solid.back().x(), depth);
  solid.emplace_back(solid.front().x(), depth);
  return solid;
}

int overlaps_with_walls(const Scene& scene, const std::vector<Points>& outlines, const std::vector<Wall>& walls) {
  int count = 0;
  for (const Wall& wall : walls)
    for (const Points& outline : outlines) count += polygons_overlap(outline, solid_of(wall, *scene.period));
  return count;
}

// EXACT: asperities that stand in the region meet no grain, by a test that the packing does not use; without the walls
// they would.
TEST(RandomPacking, SeesTheAsperitiesOfWalls) {
  Scene scene = packing_scene(PackingKind::random, mixed_shapes(), 0.6, 60);
  const std::vector<Wall> walls{capped_wall("lower", Wall::Solid::below, -3),
                                capped_wall("upper", Wall::Solid::above, 5)};
  EXPECT_GT(overlaps_with_walls(scene, outlines_of(scene, pack(scene)), walls), 3) << "else this test says nothing";
  scene.walls = walls;
  const std::vector<Points> outlines = outlines_of(scene, pack(scene));
  EXPECT_EQ(overlaps_with_walls(scene, outlines, walls), 0);
  EXPECT_EQ(overlapping_pairs(outlines, scene.period), 0);
}

// EXACT: grains come as near to asperities as the clearance lets them: a lone grain between two walls a little further
// apart than it.
TEST(RandomPacking, FillsTheRoomBetweenAsperities) {
  Scene scene = packing_scene(PackingKind::random, {disc(80, 1)}, 0.5, 8);
  scene.grains[0].size = {};
  Wall wall = capped_wall("lower", Wall::Solid::below, 0);
  wall.asperities = Asperities{1, 10, 0.5, {0}, {1.2}};
  scene.walls = {wall};
  scene.grains[0].packing.bottom = -0.5;
  scene.grains[0].packing.top = 1.55;
  const std::vector<Points> outlines = outlines_of(scene, pack(scene));
  EXPECT_EQ(overlaps_with_walls(scene, outlines, scene.walls), 0);
  for (const Points& outline : outlines)
    for (const Vec2& p : outline) EXPECT_LT(p.y(), 1.55);
}

// EXACT: walls that end at the region's edge, as flat ones do, change no bit.
TEST(RandomPacking, DoesNotSeeWallsOutside) {
  Scene scene = packing_scene(PackingKind::random, mixed_shapes(), 0.5, 20);
  const Packed alone = pack(scene);
  scene.walls = {capped_wall("lower", Wall::Solid::below, -3)};
  scene.walls[0].asperities.reset();
  const Packed beside = pack(scene);
  for (std::size_t i = 0; i < alone.grains.size(); ++i) EXPECT_EQ(alone.grains[i].centre, beside.grains[i].centre);
}

// EXACT: grains in cells do not know of walls, and are refused where they meet one.
TEST(VoronoiPacking, IsRefusedWhereItMeetsAsperities) {
  Scene scene = packing_scene(PackingKind::fourier_voronoi, mixed_shapes(), 0.5, 40);
  scene.grains[0].where = "scene.toml:7:1";
  scene.walls = {capped_wall("lower", Wall::Solid::below, -3)};
  const std::string message = error_of([&] { pack(scene); });
  EXPECT_EQ(message.find("scene.toml:7:1: packing: grain "), 0U) << message;
  EXPECT_NE(message.find("overlaps the wall 'lower', which goes to y = -2.35"), std::string::npos) << message;
}

// EXACT: bit by bit the same for a seed, on one thread and two; another for another seed.
TEST(RandomPacking, IsDeterministic) {
  Scene scene = packing_scene(PackingKind::random, mixed_shapes(), 0.7, 40);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Packed one = pack(scene);
  omp_set_num_threads(2);
  const Packed two = pack(scene);
  omp_set_num_threads(threads);
  for (std::size_t i = 0; i < one.grains.size(); ++i) {
    EXPECT_EQ(one.grains[i].centre, two.grains[i].centre);
    EXPECT_EQ(one.grains[i].angle, two.grains[i].angle);
  }
  scene.grains[0].seed = 6;
  EXPECT_NE(pack(scene).grains[0].centre, one.grains[0].centre);
}

// EXACT: a given angle is kept.
TEST(RandomPacking, KeepsAGivenAngle) {
  Scene scene = packing_scene(PackingKind::random, mixed_shapes(), 0.5, 40);
  scene.grains[0].angle = 0.3;
  for (const Placement& grain : pack(scene).grains) EXPECT_EQ(grain.angle, 0.3);
}

// EXACT: what cannot be is refused; the figure reached is named.
TEST(RandomPacking, RefusesWhatDoesNotFit) {
  const std::vector<ShapeSpec> discs{disc(60, 2)};
  EXPECT_NE(error_of([&] { pack(packing_scene(PackingKind::random, discs, 0.95, 24)); }).find("without overlap 0."),
            std::string::npos);
  EXPECT_NE(error_of([&] { pack(packing_scene(PackingKind::random, {disc(60, 4)}, 0.3, 2)); }).find("2.2 times"),
            std::string::npos);
}

// EXACT: triangles that cross without a corner in each other, one within the other, apart, touching.
TEST(RandomPacking, OverlapOfPolygons) {
  const Points triangle{{0, 0}, {4, 0}, {2, 3}};
  const auto moved = [&](double x, double y, double scale) {
    Points other;
    for (const Vec2& p : triangle) other.push_back(scale * p + Vec2(x, y));
    return other;
  };
  const Points star{{0, 2}, {2, -1}, {4, 2}};
  EXPECT_TRUE(polygons_overlap(triangle, star));
  EXPECT_TRUE(polygons_overlap(triangle, moved(1.8, 0.5, 0.1)));
  EXPECT_TRUE(polygons_overlap(moved(1.8, 0.5, 0.1), triangle));
  EXPECT_TRUE(polygons_overlap(triangle, moved(4, 0, 1)));
  EXPECT_FALSE(polygons_overlap(triangle, moved(4.01, 0, 1)));
  EXPECT_FALSE(polygons_overlap(triangle, moved(3.3, 2, 1)));
}

}  // namespace
}  // namespace pliant
