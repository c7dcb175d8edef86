#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <set>
#include <string>

#include "input/read_scene.hpp"
#include "scene/scene.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;
const fs::path cases = fs::path(PLIANT_SOURCE_DIR) / "cases";

TEST(Cases, AllParseAndNameTheirCommand) {
  // EXACT: the header of each file gives the command that runs it.
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(cases)) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    EXPECT_NO_THROW(read_scene(entry.path())) << entry.path();
    std::ifstream stream(entry.path());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(text.front(), '#') << entry.path();
    EXPECT_NE(text.find("#   ./pliant run cases/" + entry.path().filename().string()), std::string::npos)
        << entry.path();
  }
  EXPECT_GE(count, 6);
}

TEST(Cases, ThirdBodyIsThatOfTheMethod) {
  // EXACT: docs/method.md 8; a tolerance of 1e-12 covers the roundings of units and products.
  const Scene scene = read_scene(cases / "third_body.toml");
  EXPECT_NEAR(*scene.period, 87e-6, 87e-18);
  EXPECT_NEAR(scene.time.end, 18.5e-6, 18.5e-18);
  ASSERT_EQ(scene.grains.size(), 1u);
  const Packing& packing = scene.grains[0].packing;
  EXPECT_EQ(packing.kind, PackingKind::hexagonal);
  EXPECT_EQ(packing.columns * packing.rows, 2000);
  EXPECT_NEAR(packing.columns * packing.pitch, *scene.period, 1e-12 * *scene.period);
  EXPECT_FALSE(scene.grains[0].angle);
  EXPECT_EQ(scene.shapes[0].nodes, 168);
  ASSERT_EQ(scene.contacts.size(), 1u);
  EXPECT_FALSE(scene.contacts[0].stiffness);
  EXPECT_FALSE(scene.contacts[0].range);
}

TEST(Cases, GrainsOfTheThirdBodyAreTakenInTurnAndHold400MPa) {
  // EXACT: docs/method.md 8.
  for (const char* file : {"third_body.toml", "third_body_mini.toml"}) {
    const Scene scene = read_scene(cases / file);
    EXPECT_EQ(scene.grains[0].species_order, SpeciesOrder::in_turn) << file;
    EXPECT_EQ(scene.grains[0].species[0].body, BodyKind::compliant) << file;
    EXPECT_EQ(scene.contacts[0].strength, 400e6) << file;
  }
}

TEST(Cases, AsperitiesOfTheThirdBodyContinueTheLattice) {
  // EXACT: asperities lie one row under the first and over the last grain of their column, to 1e-12 of the pitch.
  for (const char* file : {"third_body.toml", "third_body_mini.toml"}) {
    const Scene scene = read_scene(cases / file);
    const Packing& packing = scene.grains[0].packing;
    ASSERT_EQ(scene.walls.size(), 2u);
    for (const Wall& wall : scene.walls) {
      const bool below = wall.solid == Wall::Solid::below;
      const Asperities& asperities = *wall.asperities;
      ASSERT_EQ(asperities.count, packing.columns);
      EXPECT_EQ(asperities.first, packing.origin.x());
      EXPECT_EQ(asperities.count % static_cast<int>(asperities.heights.size()), 0)
          << "the cycle closes over the period";
      for (std::size_t column = 0; column < 2; ++column) {
        const double shift = column == 1 ? packing.row_pitch / 2 : 0;
        const double row = below ? -1 : packing.rows;
        const double expected = packing.origin.y() + shift + row * packing.row_pitch;
        const double centre = wall.level + (below ? 1 : -1) * asperities.heights[column];
        EXPECT_NEAR(centre, expected, 1e-12 * packing.row_pitch) << file << " " << wall.name << " " << column;
        const double protrudes = asperities.heights[column] > asperities.heights[1 - column] ? 60 : 30;
        EXPECT_NEAR(asperities.half_angles[column], protrudes * std::numbers::pi / 180, 1e-15);
      }
    }
  }
}

TEST(Cases, UpperWallOfTheThirdBodyIsPressedThenSheared) {
  // EXACT
  const Scene scene = read_scene(cases / "third_body_mini.toml");
  const Wall& upper = scene.walls[1];
  EXPECT_EQ(upper.y.mode, AxisCondition::Mode::pressure);
  EXPECT_EQ(upper.y.history.at(0), 0);
  EXPECT_NEAR(upper.y.history.at(0.5e-6), 0.5e9, 1e-3);
  EXPECT_EQ(upper.y.history.at(2e-6), 1e9);
  EXPECT_EQ(upper.x.mode, AxisCondition::Mode::velocity);
  EXPECT_EQ(upper.x.history.at(0.9e-6), 0);
  EXPECT_EQ(upper.x.history.at(1.06e-6), 10);
  EXPECT_EQ(scene.walls[0].x.mode, AxisCondition::Mode::fixed);
  EXPECT_EQ(scene.walls[0].y.mode, AxisCondition::Mode::fixed);
}

TEST(Cases, PlatesApproachByThirtyPercent) {
  // EXACT: 0.3 diameters and the two gaps at the poles; tolerance: rounding.
  const Scene scene = read_scene(cases / "disc_between_plates.toml");
  const double gap = scene.walls[1].level - scene.walls[0].level - 2;
  EXPECT_NEAR(-scene.walls[1].y.history.integral(0, scene.time.end), 0.6 + gap, 1e-14);
  const Material& disc = scene.material("disc");
  EXPECT_NEAR(disc.young / (2 * (1 + disc.poisson)), 1, 1e-15);
}

TEST(Cases, HeavyBodiesStartAtTheirRestingPenetration) {
  // EXACT for the block, whose nodes touch all at once. For the disc the closed form of a smooth circle; its polygon
  // differs by the sagitta h^2/(8 R) = 0.25 um of 51 um: 0.5 %.
  const Scene block = read_scene(cases / "sliding_block.toml");
  const double block_penetration = 0.05 - block.grains[0].packing.positions[0].y();
  EXPECT_NEAR(block_penetration * *block.contacts[0].stiffness, 2000 * 0.1 * 9.81, 1e-6);
  const Scene disc = read_scene(cases / "rolling_disc.toml");
  const double weight = 2000 * std::numbers::pi * 0.05 * 0.05 * 9.81;
  const double expected = std::pow(0.75 * weight / (*disc.contacts[0].stiffness * std::sqrt(0.1)), 2.0 / 3);
  EXPECT_NEAR(0.05 - disc.grains[0].packing.positions[0].y(), expected, 0.005 * expected);
}

}  // namespace
}  // namespace pliant
