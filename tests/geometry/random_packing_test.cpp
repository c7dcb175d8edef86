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

// EXACT: no two outlines share a point, by a test of all pairs that the packing does not use; all lie in the region; each
// grain has its shape and size. A strip, and a box without a period.
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
