// What a scene may say about a cell with two periods, and how it is refused.
#include <gtest/gtest.h>

#include "input/bad_scenes.hpp"
#include "input/read_scene.hpp"

namespace pliant {
namespace {

using scene_tests::error_of;
using scene_tests::SceneFile;
using scene_tests::stones;

const std::string places = "packing = { kind = \"positions\", positions = [[1, 1], [3, 1]] }\n";
const std::string contact = "[[contacts]]\nbetween = \"all\"\nlaw = \"frictionless\"\nstiffness = 1\n";

std::string scene_in_cell(const std::string& domain, const std::string& rest = {}) {
  return stones + places + contact + "[domain]\nperiods = [4, 3]\n" + domain + rest;
}

// EXACT: periods, histories of the gradient and of stress, and how stress moves the cell.
TEST(CellInput, reads_gradients_and_stresses) {
  const SceneFile file(scene_in_cell(R"([domain.cell]
xx = [[0, 1], ["2 s", 0.5]]
xy = [["1 s", 0], ["2 s", 3]]
stress_yy = [[0, 0], ["1 s", "-2 kPa"]]
inertia = 0.1
damping = 0.5
)"));
  const Scene scene = read_scene(file.path());
  ASSERT_TRUE(scene.cell);
  EXPECT_EQ(scene.cell->periods, Vec2(4, 3));
  EXPECT_TRUE(scene.is_periodic());
  EXPECT_FALSE(scene.period);
  EXPECT_EQ(scene.shortest_period(), 3);
  Eigen::Matrix2d expected;
  expected << 0.625, 1.5, 0, 1;
  EXPECT_EQ(scene.cell->gradient_at(1.5), expected);
  ASSERT_TRUE(scene.cell->stress[1][1]);
  EXPECT_EQ(scene.cell->stress[1][1]->at(0.5), -1000);
  EXPECT_TRUE(scene.cell->is_stress_controlled());
  EXPECT_EQ(scene.cell->mass, 0.1);
  EXPECT_EQ(scene.cell->damping, 0.5);
}

// EXACT: a packing fills the cell, whose edges it needs not say.
TEST(CellInput, fills_the_cell) {
  const SceneFile file(stones + "packing = { kind = \"random\", solid_fraction = 0.5 }\nseed = 1\n" + contact +
                       "[domain]\nperiods = [10, 8]\n");
  const Packing packing = read_scene(file.path()).grains[0].packing;
  EXPECT_EQ(packing.right, 10);
  EXPECT_EQ(packing.top, 8);
  EXPECT_EQ(packing.count, 51) << "0.5 x 80 over pi/4";
}

struct BadCell {
  std::string text, message;
};

// EXACT: words of the messages.
TEST(CellInput, is_refused_with_the_reason) {
  const std::string wall = "[[walls]]\nname = \"floor\"\nmaterial = \"stone\"\nsolid = \"below\"\nlevel = 0\n";
  const BadCell all[] = {
      {scene_in_cell("period = 4\n"), "both it and 'period' are given"},
      {scene_in_cell("gravity = [0, -9.81]\n"), "nothing bears it in a cell with two periods"},
      {scene_in_cell("", wall), "wall 'floor' has no place in a cell with two periods"},
      {scene_in_cell("[domain.cell]\nxx = [[0, 0.9], [1, 0.8]]\n"), "has 0.9 at t = 0; allowed: 1"},
      {scene_in_cell("[domain.cell]\nxy = 0.1\n"), "has 0.1 at t = 0; allowed: 0"},
      {scene_in_cell("[domain.cell]\nxx = [[0, 1], [1, -0.5]]\n"), "the area of the cell is -0.5 times"},
      {scene_in_cell("[domain.cell]\nxx = [[0, 1], [1, -1]]\nyy = [[0, 1], [1, -1]]\n"),
       "the area of the cell is 0 times"},
      {scene_in_cell("[domain.cell]\nxx = 1\nstress_xx = 0\n"), "both it and 'xx' are given"},
      {scene_in_cell("[domain.cell]\ndamping = 1\n"), "allowed: a number, >= 0 and < 1"},
      {scene_in_cell("",
                     "[[probes]]\nname = \"s\"\nquantity = \"solid_fraction\"\nof = \"all\"\nperiod = 1\nbetween = "
                     "[\"a\", \"b\"]\n"),
       "unknown wall"},
      {stones + places + contact + "[domain]\nperiods = [4, 0.9]\n", "allowed: less than the period, 0.9 m"},
      {stones + places + contact + "[domain]\nperiods = [4]\n", "an array of 2 elements"},
      {stones + places + contact + "[domain]\ncell = { xx = 1 }\n", "unknown key 'cell'"},
      {stones + places + contact + "[[probes]]\nname = \"s\"\nquantity = \"cell_stress\"\nperiod = 1\n",
       "cell_stress is of a cell with two periods; add [domain] periods"},
      {stones + "packing = { kind = \"grid\", columns = 2, rows = 3, pitch = 1.5 }\n" + contact +
           "[domain]\nperiods = [4, 4]\n",
       "3 rows at a pitch of 1.5 m take 4.5 m"},
      {stones + "packing = { kind = \"random\", count = 2, bottom = 0, top = 1 }\n" + contact +
           "[domain]\nperiods = [4, 4]\n",
       "unknown key 'bottom'"},
  };
  for (const BadCell& one : all) {
    const std::string message = error_of(one.text);
    EXPECT_NE(message.find(one.message), std::string::npos) << one.text << "\n" << message;
  }
}

// EXACT: what is against a frame at rest, or moves no cell.
TEST(CellInput, has_no_frame_at_rest) {
  std::string text = scene_in_cell("");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    return other.replace(other.find(from), from.size(), to);
  };
  EXPECT_NE(error_of(changed("density = 1\n", "density = 1\nmass_damping = 2\n")).find("frame at rest"),
            std::string::npos);
  EXPECT_NE(error_of(changed("end = 1\n", "end = 1\nintegrator = \"step-doubling\"\n")).find("does not move a cell"),
            std::string::npos);
  EXPECT_NE(error_of(text + "[discretisation]\nmass = \"corrected\"\n").find("does not follow a cell"),
            std::string::npos);
  EXPECT_NE(error_of(text + "[[boundary]]\nof = \"grains\"\nx = \"fixed\"\n").find("do not move with a cell"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
