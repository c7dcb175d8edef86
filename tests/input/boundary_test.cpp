// What a scene may say about its boundary conditions, damping and drives, and how it is refused.
#include <gtest/gtest.h>

#include <numbers>

#include "core/errors.hpp"
#include "input/read_scene.hpp"
#include "scene_files.hpp"

namespace pliant {
namespace {

using scene_tests::good_scene;
using scene_tests::SceneFile;
using Kind = BoundaryCondition::Kind;

Scene with(const std::string& text) {
  const SceneFile file(good_scene + text);
  return read_scene(file.path());
}

const std::string rigid_set = R"([[grains]]
name = "stones"
shape = "disc"
packing = { kind = "positions", positions = [["2 um", "20 um"], ["5 um", "20 um"]] }
body = "rigid"
material = "hard"
)";

// EXACT: every key of the three kinds.
TEST(Boundary, ReadsDrivesPressuresAndSupports) {
  const Scene scene = with(rigid_set + R"(
[[boundary]]
of = "stones 1"
x = { velocity = [[0, "1 m/s"], ["1 us", "2 m/s"]], until = "1.5 us" }
y = "fixed"
angle = { moment = "3 N", damping = "2 N s" }
[[boundary]]
of = "boxes"
part = { side = "top" }
pressure = "4 MPa"
mode = "oriented"
direction = [0, -2]
from = "0.1 us"
until = "0.5 us"
[[boundary]]
of = "boxes 0"
part = { angles = ["315 deg", "45 deg"] }
x = { displacement = "0.1 um" }
y = { velocity = "1 m/s" }
stiffness = "1e15 Pa/m"
damping = "1e6 Pa s/m"
[[boundary]]
of = "grains"
pressure = [[0, 0], ["1 us", "1 MPa"]]
part = { box = [[0, 0], ["10 um", "2 um"]] }
)");
  ASSERT_EQ(scene.boundary.size(), 4u);
  const BoundaryCondition &drive = scene.boundary[0], &dead = scene.boundary[1], &support = scene.boundary[2],
                          &following = scene.boundary[3];
  EXPECT_EQ(drive.kind, Kind::axes);
  EXPECT_EQ(drive.grains, "stones");
  EXPECT_EQ(drive.number, 1);
  EXPECT_EQ(drive.x.mode, AxisCondition::Mode::velocity);
  EXPECT_DOUBLE_EQ(drive.x.window.until, 1.5e-6);
  EXPECT_FALSE(drive.x.window.contains(1.5e-6));
  EXPECT_TRUE(drive.x.window.contains(0));
  EXPECT_EQ(drive.y.mode, AxisCondition::Mode::fixed);
  EXPECT_EQ(drive.angle.mode, AxisCondition::Mode::force);
  EXPECT_DOUBLE_EQ(drive.angle.damping, 2);
  EXPECT_EQ(dead.kind, Kind::pressure);
  EXPECT_FALSE(dead.number);
  EXPECT_FALSE(dead.following);
  EXPECT_EQ(*dead.direction, Vec2(0, -1));
  EXPECT_EQ(dead.part.side, Vec2(0, 1));
  EXPECT_DOUBLE_EQ(dead.window.from, 1e-7);
  EXPECT_EQ(support.kind, Kind::support);
  EXPECT_EQ(support.x.mode, AxisCondition::Mode::displacement);
  EXPECT_DOUBLE_EQ(*support.stiffness, 1e15);
  EXPECT_DOUBLE_EQ(support.damping, 1e6);
  EXPECT_NEAR(support.part.first, 7 * std::numbers::pi / 4, 1e-12);
  EXPECT_EQ(following.kind, Kind::pressure);
  EXPECT_TRUE(following.following);
  EXPECT_DOUBLE_EQ(following.part.high.y(), 2e-6);
  EXPECT_DOUBLE_EQ(following.pressure.at(5e-7), 5e5);
}

// EXACT
TEST(Boundary, ReadsDampingOfMaterialsAndWalls) {
  std::string text = good_scene;
  text.replace(text.find("poisson = 0.4"), 13, "poisson = 0.4\nviscosity = \"3 Pa s\"\nmass_damping = \"2e5 s-1\"");
  text.replace(text.find("\"1 GPa\"]] }"), 11, "\"1 GPa\"]], damping = \"4 kPa s/m\", until = \"1 us\" }");
  const SceneFile file(text);
  const Scene scene = read_scene(file.path());
  EXPECT_DOUBLE_EQ(scene.material("soft").viscosity, 3);
  EXPECT_DOUBLE_EQ(scene.material("soft").mass_damping, 2e5);
  EXPECT_DOUBLE_EQ(scene.walls[1].y.damping, 4000);
  EXPECT_DOUBLE_EQ(scene.walls[1].y.window.until, 1e-6);
}

// EXACT: an integral's inverse.
TEST(History, SlopeIsThatOfThePieceAfterAKink) {
  const History history{{0, 1, 3}, {0, 2, 1}};
  EXPECT_EQ(history.slope(-1), 0);
  EXPECT_EQ(history.slope(0), 2);
  EXPECT_EQ(history.slope(1), -0.5);
  EXPECT_EQ(history.slope(3), 0);
}

struct BadCondition {
  std::string name, text, phrase;
};

class BadBoundary : public ::testing::TestWithParam<BadCondition> {};

// EXACT: words of the message.
TEST_P(BadBoundary, IsRefusedWithReason) {
  const auto& [name, text, phrase] = GetParam();
  try {
    with(rigid_set + text);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(phrase), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(".toml:"), std::string::npos) << "line and column";
  }
}

const std::string on_boxes = "[[boundary]]\nof = \"boxes\"\n";
const std::string on_stones = "[[boundary]]\nof = \"stones\"\n";
const std::string of_cells = "cells = 4\nseed = 1\n";  // a key of the grains before

// EXACT: what does the same to all cells may act on a whole grain, and one cell may bear anything.
TEST(Boundary, MovesBreakableGrains) {
  const std::string text = rigid_set + of_cells;
  EXPECT_NO_THROW(with(text + on_stones + "x = { velocity = 1 }\ny = \"fixed\"\nangle = \"fixed\"\n"));
  EXPECT_NO_THROW(with(text + "[[boundary]]\nof = \"stones 7\"\ny = { force = 1 }\nangle = { moment = 1 }\n"));
}

INSTANTIATE_TEST_SUITE_P(
    Boundary, BadBoundary,
    ::testing::Values(
        BadCondition{"UnknownTarget", "[[boundary]]\nof = \"boxs\"\npressure = 1\n", "nearest: boxes"},
        BadCondition{"WallAsTarget", "[[boundary]]\nof = \"floor\"\npressure = 1\n", "unknown set of grains \"floor\""},
        BadCondition{"NumberTooLarge", "[[boundary]]\nof = \"boxes 2\"\npressure = 1\n", "a number from 0 to 1"},
        BadCondition{"Nothing", on_boxes, "missing key 'pressure'"},
        BadCondition{"Mixed", "[[boundary]]\nof = \"grains\"\nx = \"fixed\"\n", "mixes rigid and compliant"},
        BadCondition{"Both", on_boxes + "x = \"fixed\"\npressure = 1\n", "unknown key 'pressure'"},
        BadCondition{"AllFree", on_boxes + "x = \"free\"\n", "does nothing"},
        BadCondition{"AngleOfCompliant", on_boxes + "x = \"fixed\"\nangle = \"fixed\"\n",
                     "'angle' is for rigid grains only"},
        BadCondition{"ForceOnSupport", on_boxes + "x = { force = 1 }\n", "unknown key 'force'"},
        BadCondition{"StiffnessOfRigid", on_stones + "x = \"fixed\"\nstiffness = 1\n", "unknown key 'stiffness'"},
        BadCondition{"TwoDrivesOfAnAxis",
                     on_stones + "x = \"fixed\"\n[[boundary]]\nof = \"stones 1\"\nx = { force = 1 }\n",
                     "driven by an earlier"},
        BadCondition{"ForceOnCells", of_cells + on_stones + "y = { force = 1 }\n", "name one, as in \"stones 0\""},
        BadCondition{"RotationOfCells", of_cells + on_stones + "angle = { velocity = 1 }\n",
                     "name one, as in \"stones 0\""},
        BadCondition{"TwoParts", on_boxes + "pressure = 1\npart = { side = \"top\", angles = [0, 1] }\n",
                     "one of angles"},
        BadCondition{"NoPart", on_boxes + "pressure = 1\npart = { }\n", "one of angles"},
        BadCondition{"EqualAngles", on_boxes + "pressure = 1\npart = { angles = [1, 1] }\n", "two different"},
        BadCondition{"TurnedBox", on_boxes + "pressure = 1\npart = { box = [[1, 0], [0, 1]] }\n", "left < right"},
        BadCondition{"UnknownSide", on_boxes + "pressure = 1\npart = { side = \"tip\" }\n", "nearest: top"},
        BadCondition{"DirectionOfFollowing", on_boxes + "pressure = 1\ndirection = [0, 1]\n",
                     "unknown key 'direction'"},
        BadCondition{"NoDirection", on_boxes + "pressure = 1\nmode = \"oriented\"\ndirection = [0, 0]\n", "[0, 0]"},
        BadCondition{"EndsBeforeItStarts", on_boxes + "pressure = 1\nfrom = \"2 us\"\nuntil = \"1 us\"\n",
                     "after 'from'"},
        BadCondition{"DampedVelocity", on_stones + "x = { velocity = 1, damping = 1 }\n", "unknown key 'damping'"},
        BadCondition{"NegativeDamping", on_boxes + "x = \"fixed\"\ndamping = -1\n", ">= 0"}),
    [](const auto& info) { return info.param.name; });

// EXACT
TEST(LinearElastic, IsRefusedForGrainsThatStartTurned) {
  std::string text = good_scene;
  text.replace(text.find("neo-hookean"), 11, "linear-elastic");
  const SceneFile file(text);
  try {
    read_scene(file.path());
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("rotations as strains"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace pliant
