// Frames' pairs in touch: closed forms, and the forces of the step.
#include <gtest/gtest.h>

#include <map>

#include "results/contact_network.hpp"
#include "setup/build_model.hpp"
#include "support/probing.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double single = 1.2e-7;  ///< rounding of the table's numbers, relative

const std::vector<float>& column(const FrameTable& table, const std::string& name) {
  for (const FrameTable::Column& c : table.columns)
    if (c.name == name) return c.values;
  throw std::logic_error("no column " + name);
}

Vec2 row(const FrameTable& table, const std::string& name, std::size_t i) {
  const std::vector<float>& values = column(table, name);
  return {values.at(2 * i), values.at(2 * i + 1)};
}

/// A rigid block of 1 x 0.5 over the seam of the period, 0.004 inside a floor and a lid.
Scene block_over_the_seam() {
  Scene scene = on_a_floor(1, 4, 0.1, {0, 0});
  scene.shapes = {box_shape("block", 1, 0.5, 0.1)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{0, 0.246}})};
  scene.walls.push_back(flat_wall("lid", Wall::Solid::above, 0.492, 0.1));
  scene.contacts = {mohr_coulomb(100, 0.3)};
  return scene;
}

TEST(ContactNetwork, block_over_the_seam_between_walls) {
  const Model model = build_model(block_over_the_seam());
  Simulation simulation(model);
  const FrameTable table = contact_network(Snapshot(simulation));
  ASSERT_EQ(column(table, "bodies"), (std::vector<float>{0, 1, 0, 2})) << "EXACT";
  for (const std::size_t wall : {0, 1}) {
    const double outward = wall == 0 ? -1 : 1;
    EXPECT_NEAR(column(table, "length")[wall], 1.004, 10 * single)
        << "EXACT: the block's face, and half of its sides inside";
    EXPECT_NEAR((row(table, "force", wall) - Vec2(0, 0.4 * 0.998 * outward)).norm(), 0, 10 * single)
        << "EXACT: kn depth times the face less half the depth";
    const Vec2 middle(0, 0.246 + 0.248 * outward);
    EXPECT_NEAR((row(table, "point", wall) - middle).norm(), 0, 0.004 * 0.004)
        << "EXACT: between both faces, but for ends";
  }
}

/// Rigid discs in hexagonal order, pressed into each other, periodic in x.
Scene pressed_discs() {
  Scene scene = empty_scene(1);
  scene.period = 4 * 0.98 * std::sqrt(3) / 2;
  scene.shapes = {polygonal_disc("disc", 1, 96)};
  Grains layer = grains("layer", "disc", BodyKind::rigid, {});
  layer.packing = {PackingKind::hexagonal, 4, 3, 0.98 * std::sqrt(3) / 2, 0.98, {0.1, 0}, {}};
  scene.grains = {layer};
  scene.contacts = {mohr_coulomb(100, 0.3)};
  return scene;
}

TEST(ContactNetwork, forces_add_up_to_those_of_the_step) {
  const Model model = build_model(pressed_discs());
  Simulation simulation(model);
  const Snapshot snapshot(simulation);
  const FrameTable table = contact_network(snapshot);
  std::vector<Vec2> sums(model.bodies.size(), Vec2(0, 0));
  double largest = 0;
  for (std::size_t i = 0; i < column(table, "images").size(); ++i) {
    const Vec2 bodies = row(table, "bodies", i), force = row(table, "force", i);
    sums[static_cast<std::size_t>(bodies.x())] -= force, sums[static_cast<std::size_t>(bodies.y())] += force;
    largest = std::max(largest, force.norm());
  }
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    Vec2 of_the_step(0, 0);
    for (int i = model.outline_offset[b]; i < model.outline_end(b); ++i) of_the_step += snapshot.contact_force().at(i);
    EXPECT_NEAR((sums[b] - of_the_step).norm(), 0, 10 * single * largest) << "INDEPENDENT, body " << b;
  }
  EXPECT_GT(largest, 0);
}

/// The point of a contact lies between both centres, where the first body sees the second.
TEST(ContactNetwork, points_lie_half_way_between_discs) {
  const Model model = build_model(pressed_discs());
  Simulation simulation(model);
  const FrameTable table = contact_network(Snapshot(simulation));
  int across = 0;
  for (std::size_t i = 0; i < column(table, "images").size(); ++i) {
    const float images = column(table, "images")[i];
    const Vec2 bodies = row(table, "bodies", i), first = model.bodies[static_cast<std::size_t>(bodies.x())].centre,
               second =
                   model.bodies[static_cast<std::size_t>(bodies.y())].centre + Vec2(images * *model.scene.period, 0);
    EXPECT_NEAR((second - first).norm(), 0.98, 10 * single) << "EXACT: the pitch";
    // Nodes of 96 a disc: which of them touch may differ between both by one at either end, 0.033 apart.
    EXPECT_NEAR((row(table, "point", i) - 0.5 * (first + second)).norm(), 0, 0.033) << "EXACT but for the nodes";
    across += images != 0;
  }
  EXPECT_EQ(across, 5) << "EXACT: three rows, odd columns half a pitch up: two pairs each but for the top's";
}

}  // namespace
}  // namespace pliant::dynamics_tests
