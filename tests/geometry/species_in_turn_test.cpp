#include "geometry/species_in_turn.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/assembly.hpp"
#include "shapes.hpp"

namespace pliant {
namespace {

using testing::error_of;

// EXACT throughout.

TEST(TakeTurns, EqualSharesGoRound) {
  EXPECT_EQ(take_turns({0.5, 0.5}, 5), (std::vector<int>{0, 1, 0, 1, 0}));
  EXPECT_EQ(take_turns({1 / 3., 1 / 3., 1 / 3.}, 7), (std::vector<int>{0, 1, 2, 0, 1, 2, 0}));
  EXPECT_EQ(take_turns({1}, 3), (std::vector<int>{0, 0, 0}));
  // 0.1 + 0.2 is not 0.3 to the last bit, and still as large.
  EXPECT_EQ(take_turns({0.3, 0.1 + 0.2, 0.4}, 3), (std::vector<int>{2, 0, 1}));
}

TEST(TakeTurns, OtherSharesAreSpreadEvenly) {
  EXPECT_EQ(take_turns({0.25, 0.75}, 8), (std::vector<int>{1, 0, 1, 1, 1, 0, 1, 1}));
  EXPECT_EQ(take_turns({0.8, 0.2}, 10), (std::vector<int>{0, 0, 1, 0, 0, 0, 0, 1, 0, 0}));
}

TEST(TakeTurns, EveryBeginningHasTheShares) {
  const std::vector<double> shares{0.07, 0.21, 0.29, 0.43};
  const std::vector<int> choice = take_turns(shares, 500);
  std::vector<int> taken(shares.size(), 0);
  for (int k = 1; k <= 500; ++k) {
    ++taken[choice[k - 1]];
    for (std::size_t m = 0; m < shares.size(); ++m) ASSERT_LT(std::abs(taken[m] - shares[m] * k), 1) << k << ' ' << m;
  }
  EXPECT_EQ(taken, (std::vector<int>{35, 105, 145, 215}));
}

/// Discs on a lattice as the third body's, half of them compliant.
Scene mixed(PackingKind kind, int columns, int rows) {
  Scene scene;
  scene.period = columns * 0.87;
  scene.shapes = {testing::disc(60, 1)};
  scene.materials.resize(2);
  scene.materials[0].name = "soft";
  scene.materials[1].name = "hard";
  Grains grains;
  grains.name = "layer";
  grains.shape = "disc";
  grains.packing.kind = kind;
  grains.packing.columns = columns;
  grains.packing.rows = rows;
  grains.packing.pitch = 0.87;
  grains.packing.row_pitch = 1.002;
  grains.species = {{BodyKind::compliant, "soft", 0.5}, {BodyKind::rigid, "hard", 0.5}};
  grains.species_order = SpeciesOrder::in_turn;
  grains.angle = std::nullopt;
  grains.seed = 1;
  scene.grains = {grains};
  return scene;
}

/// The grain of a body's place, counted up each column and column after column.
long count_along_columns(const Packing& packing, const PlacedBody& body) {
  const long column = std::lround(body.centre.x() / packing.pitch);
  const double shift = packing.kind == PackingKind::hexagonal && column % 2 == 1 ? 0.5 : 0;
  return column * packing.rows + std::lround(body.centre.y() / packing.row_pitch - shift);
}

TEST(SpeciesInTurn, KindsAlternateUpEachColumnAndFromOneToTheNext) {
  for (const PackingKind kind : {PackingKind::hexagonal, PackingKind::grid})
    for (const int rows : {20, 3}) {
      Scene scene = mixed(kind, 4, rows);
      const std::vector<PlacedBody> bodies = place_bodies(scene);
      ASSERT_EQ(bodies.size(), 4u * rows);
      for (const PlacedBody& body : bodies) {
        const bool first = count_along_columns(scene.grains[0].packing, body) % 2 == 0;
        EXPECT_EQ(body.kind, first ? BodyKind::compliant : BodyKind::rigid) << body.name;
        EXPECT_EQ(scene.materials[body.material].name, first ? "soft" : "hard") << body.name;
      }
    }
}

// Rows of one kind: of 29 pairs of neighbours a column, 10 in the mean are of one row, 9.5 of two and 9.5 of the
// column.
TEST(SpeciesInTurn, LikeNeighboursOfTheThirdBody) {
  Scene scene = mixed(PackingKind::hexagonal, 10, 20);
  const std::vector<PlacedBody> bodies = place_bodies(scene);
  int pairs = 0, like = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      Vec2 branch = bodies[j].centre - bodies[i].centre;
      branch.x() -= std::round(branch.x() / *scene.period) * *scene.period;
      if (branch.norm() > 1.3) continue;
      ++pairs;
      like += bodies[i].kind == bodies[j].kind;
    }
  EXPECT_EQ(pairs, 10 * 58);
  EXPECT_EQ(like, 10 * 20);
}

TEST(SpeciesInTurn, PositionsAsListed) {
  Scene scene = mixed(PackingKind::positions, 1, 1);
  scene.grains[0].packing.positions = {{3, 0}, {1, 0}, {5, 0}};
  const std::vector<PlacedBody> bodies = place_bodies(scene);
  ASSERT_EQ(bodies.size(), 3u);
  EXPECT_EQ(bodies[1].centre.x(), 1);
  EXPECT_EQ(bodies[0].kind, BodyKind::compliant);
  EXPECT_EQ(bodies[1].kind, BodyKind::rigid);
  EXPECT_EQ(bodies[2].kind, BodyKind::compliant);
}

/// EXACT: the end of a row of studies, with nothing of one kind.
TEST(SpeciesInTurn, AShareOfNothingIsNoGrain) {
  for (const SpeciesOrder order : {SpeciesOrder::in_turn, SpeciesOrder::random})
    for (const double share : {0.0, 1.0}) {
      Scene scene = mixed(PackingKind::grid, 3, 2);
      scene.grains[0].species[0].share = share;
      scene.grains[0].species[1].share = 1 - share;
      scene.grains[0].species_order = order;
      for (const PlacedBody& body : place_bodies(scene))
        EXPECT_EQ(body.kind, share == 1 ? BodyKind::compliant : BodyKind::rigid);
    }
}

TEST(SpeciesInTurn, AShareOfLessThanOneGrainIsRefused) {
  for (const SpeciesOrder order : {SpeciesOrder::in_turn, SpeciesOrder::random}) {
    Scene scene = mixed(PackingKind::grid, 2, 2);
    scene.grains[0].species[0].share = 0.9;
    scene.grains[0].species[1].share = 0.1;
    scene.grains[0].species_order = order;
    scene.grains[0].where = "scene.toml:7:1";
    const std::string message = error_of([&] { place_bodies(scene); });
    EXPECT_TRUE(message.starts_with("scene.toml:7:1: species: a share of 0.1 of 4 grains")) << message;
    EXPECT_NE(message.find("'hard'"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace pliant
