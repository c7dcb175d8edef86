// Packings in a cell with two periods.
#include <gtest/gtest.h>

#include "geometry/polygon.hpp"
#include "geometry/power_diagram.hpp"
#include "packings.hpp"
#include "support/random.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr Strip cell_region{0, 10, 0, 8, true, true};

Scene scene_of_cell(PackingKind kind, const std::vector<ShapeSpec>& shapes, double solid_fraction, int count) {
  Scene scene = packing_scene(kind, shapes, solid_fraction, count);
  scene.period.reset();
  scene.cell.emplace();
  scene.cell->periods = {10, 8};
  scene.grains[0].packing.bottom = 0, scene.grains[0].packing.top = 8;
  return scene;
}

std::vector<ShapeSpec> round_and_long() {
  return {disc(80, 1), curve("egg", ellipse(1.4, 0.7), 80),
          curve("pebble", fourier_grain(1, {0.15, 0.1, 0.05}, 3), 80)};
}

/// Pairs of outlines that share a point, images along both periods and own ones too.
int pairs_that_overlap(const std::vector<Points>& outlines) {
  int count = 0;
  for (std::size_t i = 0; i < outlines.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      for (const double x : {-10.0, 0.0, 10.0})
        for (const double y : {-8.0, 0.0, 8.0}) {
          if (i == j && x == 0 && y == 0) continue;
          Points other = outlines[j];
          for (Vec2& p : other) p += Vec2(x, y);
          count += polygons_overlap(outlines[i], other);
        }
  return count;
}

// EXACT: no two outlines share a point, over all images; the solid fraction is the one asked for. Some grains lie over
// each edge of the cell, so that the packing knows none.
TEST(CellPacking, is_free_of_overlap_across_both_periods) {
  for (const PackingKind kind : {PackingKind::random, PackingKind::fourier_voronoi}) {
    const Scene scene = scene_of_cell(kind, round_and_long(), 0.7, 81);
    const std::vector<Points> outlines = outlines_of(scene, pack(scene));
    EXPECT_EQ(pairs_that_overlap(outlines), 0);
    if (kind == PackingKind::fourier_voronoi) {
      EXPECT_NEAR(covered_area(outlines) / 80, 0.7, 1e-9);
    }
    int beyond[2] = {0, 0};
    for (const Points& outline : outlines)
      for (int axis = 0; axis < 2; ++axis) {
        double low = 1e300, high = -1e300;
        for (const Vec2& p : outline) low = std::min(low, p[axis]), high = std::max(high, p[axis]);
        const double period = axis == 0 ? 10 : 8;
        beyond[axis] += low < 0 || high > period;
      }
    EXPECT_GT(beyond[0], 3);
    EXPECT_GT(beyond[1], 3);
  }
}

// INDEPENDENT: brute force over all images says whose cell a point is in. EXACT: the cells cover the area.
TEST(CellPacking, has_the_power_diagram_of_brute_force) {
  for (const int count : {1, 2, 5, 60}) {
    Random random(7);
    Points points;
    std::vector<double> weights;
    for (int i = 0; i < count; ++i)
      points.push_back({random.uniform(0, 10), random.uniform(0, 8)}), weights.push_back(random.uniform(0, 1));
    const std::vector<Points> cells = power_cells(points, weights, cell_region);
    EXPECT_NEAR(covered_area(cells), 80, 1e-11);
    for (int k = 0; k < 300; ++k) {
      const Vec2 x{random.uniform(0, 10), random.uniform(0, 8)};
      int best = 0, owner = -1, owners = 0;
      double least = 1e300;
      for (int i = 0; i < count; ++i)
        for (int a = -2; a <= 2; ++a)
          for (int b = -2; b <= 2; ++b) {
            const Vec2 shift(10.0 * a, 8.0 * b);
            const double distance = (x - points[i] - shift).squaredNorm() - weights[i];
            if (distance < least) least = distance, best = i;
            if (!cells[i].empty() && is_inside(cells[i], x - shift)) owner = i, ++owners;
          }
      EXPECT_EQ(owners, 1);
      EXPECT_EQ(owner, best);
    }
  }
}

// Grains for which a period is too short: the message names the period and the factor.
TEST(CellPacking, refuses_short_periods) {
  Scene scene = scene_of_cell(PackingKind::random, {disc(80, 4)}, 0.3, 2);
  scene.cell->periods = {30, 8};
  scene.grains[0].packing.right = 30;
  EXPECT_THROW(pack(scene), std::runtime_error);
}

}  // namespace
}  // namespace pliant
