#include <gtest/gtest.h>

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

}  // namespace
}  // namespace pliant
