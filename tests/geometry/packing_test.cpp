#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/assembly.hpp"
#include "geometry/mesh.hpp"
#include "shapes.hpp"

namespace pliant {
namespace {

using testing::error_of;

Packing hexagonal(int columns, int rows) {
  Packing packing;
  packing.kind = PackingKind::hexagonal;
  packing.columns = columns;
  packing.rows = rows;
  packing.pitch = 0.87e-6;
  packing.row_pitch = 1.002e-6;
  packing.origin = {0.2e-6, 3e-6};
  return packing;
}

// EXACT: row by row; odd columns half a row pitch higher.
TEST(Packing, HexagonalPositions) {
  const Points centres = packing_positions(hexagonal(4, 3), std::nullopt);
  ASSERT_EQ(centres.size(), 12U);
  EXPECT_EQ(centres[0], Vec2(0.2e-6, 3e-6));
  EXPECT_NEAR(centres[5].x(), 1.07e-6, 1e-20);
  EXPECT_NEAR(centres[5].y(), 4.503e-6, 1e-20);
  EXPECT_NEAR(centres[6].x(), 1.94e-6, 1e-20);
  EXPECT_NEAR(centres[6].y(), 4.002e-6, 1e-20);
}

// EXACT: the third body's packing, 2000 discs in a period of 87 um, has no two centres nearer than the row pitch or
// sqrt(0.87^2 + 0.501^2) um, also across the period.
TEST(Packing, ThirdBodyFillsThePeriodWithoutOverlap) {
  const double period = 87e-6;
  const Points centres = packing_positions(hexagonal(100, 20), period);
  ASSERT_EQ(centres.size(), 2000U);
  double least = period;
  for (std::size_t i = 0; i < centres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      Vec2 d = centres[j] - centres[i];
      d.x() -= std::round(d.x() / period) * period;
      least = std::min(least, d.norm());
    }
  EXPECT_NEAR(least, 1.002e-6, 1e-15);
}

// EXACT: grids do not alternate; given positions stay.
TEST(Packing, GridAndPositions) {
  Packing packing = hexagonal(2, 2);
  packing.kind = PackingKind::grid;
  EXPECT_EQ(packing_positions(packing, std::nullopt)[1].y(), 3e-6);
  packing.kind = PackingKind::positions;
  packing.positions = {{1, 2}, {3, 4}};
  EXPECT_EQ(packing_positions(packing, 1.0), packing.positions);
}

// EXACT: what does not fit the period is refused.
TEST(Packing, RefusesWhatDoesNotFit) {
  EXPECT_NE(error_of([] { packing_positions(hexagonal(11, 2), 8.7e-6); }).find("fewer columns"), std::string::npos);
  EXPECT_NE(error_of([] { packing_positions(hexagonal(11, 2), 11 * 0.87e-6); }).find("even number"), std::string::npos);
  EXPECT_NE(error_of([] { packing_positions(hexagonal(0, 2), 8.7e-6); }).find("positive"), std::string::npos);
}

/// A scene whose grains are listed, of a square and a disc twice as large.
Scene listed(const std::vector<std::pair<std::string, double>>& shares) {
  Scene scene;
  scene.shapes = {testing::square(40), testing::disc(40, 4 * std::sqrt(4 / std::numbers::pi))};
  scene.materials = {{.name = "any"}};
  Grains grains;
  for (const auto& [shape, share] : shares) grains.shapes.push_back({shape, share});
  grains.packing.positions = {{3, 0}, {1, 5}, {7, 0}, {9, 9}};
  grains.species = {{BodyKind::rigid, "any", 1}};
  scene.grains = {grains};
  return scene;
}

// EXACT: of whatever shape a grain is, its area is that of the circle; angles are as listed.
TEST(Packing, SizesAndAnglesAreAsListed) {
  Scene scene = listed({{"square", 0.5}, {"disc", 0.5}});
  Packing& packing = scene.grains[0].packing;
  packing.diameters = {1, 2, 3, 4};
  packing.angles = {0.1, 0, -2, 7};
  const std::vector<PlacedBody> bodies = place_bodies(scene);
  ASSERT_EQ(bodies.size(), 4U);
  int discs = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const PlacedBody& body = bodies[i];
    discs += body.shape;
    const double area = body.scale * body.scale * polygon_properties(make_outline(scene.shapes[body.shape])).area;
    EXPECT_NEAR(area, std::numbers::pi / 4 * packing.diameters[i] * packing.diameters[i], 1e-14 * area);
    EXPECT_EQ(body.angle, packing.angles[i]);
    EXPECT_EQ(body.centre, packing.positions[i]);
  }
  EXPECT_EQ(discs, 2);
}

TEST(Packing, ScalesAndShapesAreAsListed) {
  Scene scene = listed({{"square", 1}});
  scene.grains[0].packing.scales = {1, 0.5, 2, 1};
  scene.grains[0].packing.shapes = {1, 0, 0, 1};
  const std::vector<PlacedBody> bodies = place_bodies(scene);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(bodies[i].scale, scene.grains[0].packing.scales[i]);
    EXPECT_EQ(bodies[i].shape, scene.grains[0].packing.shapes[i]);
  }
}

}  // namespace
}  // namespace pliant
