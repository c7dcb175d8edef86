// What a run says of bodies that overlap at its start: pairs, depth, energy; what it advises undoes the overlap.
#include "contact/initial_overlap.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

Scene with(const ShapeSpec& shape, const Points& centres) {
  Scene scene = empty_scene(1);
  scene.shapes = {shape};
  scene.grains = {grains("bodies", shape.name, BodyKind::rigid, centres)};
  return scene;
}

/// Corner on corner: the polygon of a disc's area reaches beyond its circle.
TEST(InitialOverlap, discs_a_diameter_apart) {
  constexpr double turn = 2 * std::numbers::pi / 48;
  const double reach = std::sqrt(turn / std::sin(turn)), half_side = reach * std::sin(turn / 2);
  const double depth = 2 * (reach - 1) * std::cos(turn / 2);
  const Model model = build_model(with(polygonal_disc("disc", 2, 48), {{0, 0}, {2, 0}}));
  const InitialOverlap overlap = Simulation(model).overlap();
  EXPECT_EQ(overlap.pairs, 1) << "EXACT";
  EXPECT_NEAR(overlap.depth, depth, 1e-12) << "EXACT";
  EXPECT_NEAR(overlap.share, depth / (2 * half_side), 1e-12) << "EXACT";
  EXPECT_NEAR(overlap.stored, 0.5 * 100 * depth * depth * 2 * half_side, 1e-12)
      << "EXACT: one node of each, of weight 1/2, over its tributary length";
  const std::string text = describe(overlap, model);
  EXPECT_NE(text.find("1 pair of bodies, 'bodies 0' and 'bodies 1' deepest by 0.00285 m, 0.022 of a segment"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("apart by 0.0029 m"), std::string::npos) << text;
}

// RATE: rigid corners that start deep in each other, a fourth of a segment and more, are pushed apart by what is stored
// there and no more. Forces turn where nodes change their faces, which costs a step there, of either sign: at most what
// a run warns of, and a tenth of it with a fortieth of the step. When the face that a node touches changed at once they
// gained seven times what was stored, whatever the step.
TEST(InitialOverlap, of_corner_in_corner_sets_free_what_it_stores) {
  const auto balance = [](double safety) {
    Scene scene = with(polygonal_disc("disc", 2, 8), {{0, 0}});
    scene.grains.push_back(grains("turned", "disc", BodyKind::rigid, {{1.8, 0.3}}));
    scene.grains[1].angle = 20 * std::numbers::pi / 180;
    scene.contacts = {frictionless(80)};
    scene.time.end = 3;
    scene.time.safety = safety;
    const Model model = build_model(scene);
    Simulation simulation(model);
    EXPECT_GT(simulation.overlap().share, 0.25);
    advance(simulation, scene.time.end);
    return simulation.balance_error(simulation.energy_balance().energy);
  };
  EXPECT_LT(balance(0.8), 0.01);
  EXPECT_LT(balance(0.02), 0.001);
}

TEST(InitialOverlap, goes_with_the_advised_distance) {  // EXACT
  const ShapeSpec disc = polygonal_disc("disc", 2, 48), block = box_shape("block", 1, 1, 0.1);
  for (const auto& [shape, second] : {std::pair(disc, Vec2(2, 0)), std::pair(block, Vec2(0.95, 0)),
                                      std::pair(block, Vec2(0.95, 0.47)), std::pair(block, Vec2(0.02, -0.97))}) {
    const Model model = build_model(with(shape, {{0, 0}, second}));
    const InitialOverlap before = Simulation(model).overlap();
    ASSERT_EQ(before.pairs, 1);
    Vec2 way(0, 0);
    const int axis = std::abs(second.x()) > std::abs(second.y()) ? 0 : 1;
    way[axis] = std::copysign(1.01 * before.separation, second[axis]);
    const Model apart = build_model(with(shape, {{0, 0}, second + way}));
    EXPECT_EQ(Simulation(apart).overlap().pairs, 0) << second.transpose();
  }
}

TEST(InitialOverlap, of_a_lattice_goes_with_the_advised_pitch) {  // EXACT
  Scene scene = with(polygonal_disc("disc", 2, 48), {});
  Packing& packing = scene.grains[0].packing;
  packing.kind = PackingKind::hexagonal;
  packing.columns = 3, packing.rows = 3, packing.pitch = std::sqrt(3.0), packing.row_pitch = 2;
  const Model model = build_model(scene);
  const InitialOverlap tight = Simulation(model).overlap();
  EXPECT_EQ(tight.pairs, 6 + 10) << "in columns of three, and from each column to the next";
  EXPECT_GT(tight.growth, 1);
  EXPECT_NE(describe(tight, model).find("times as large"), std::string::npos) << describe(tight, model);
  packing.pitch *= tight.growth * (1 + 1e-6), packing.row_pitch *= tight.growth * (1 + 1e-6);
  EXPECT_EQ(Simulation(build_model(scene)).overlap().pairs, 0);
}

TEST(InitialOverlap, counts_pairs_and_names_the_deepest) {  // EXACT
  const Model model = build_model(with(box_shape("block", 1, 1, 0.1), {{0, 0}, {0.98, 0}, {1.93, 0.3}, {4, 0}}));
  const InitialOverlap overlap = Simulation(model).overlap();
  EXPECT_EQ(overlap.pairs, 2);
  EXPECT_EQ(overlap.first, 1);
  EXPECT_EQ(overlap.second, 2);
  EXPECT_NEAR(overlap.depth, 0.05, 1e-12);
  EXPECT_NEAR(overlap.share, 0.5, 1e-12);
}

/// Stores energy at a gap of nothing, and at a gap that cohesion spans.
TEST(InitialOverlap, is_not_cohesion) {  // EXACT
  Scene scene = with(box_shape("block", 1, 1, 0.1), {{0, 0}, {1.001, 0}});
  ContactRule& rule = scene.contacts[0];
  rule.law = ContactLawKind::cohesive, rule.strength = 1, rule.range = 0.02;
  const Model joined = build_model(scene);
  EXPECT_EQ(Simulation(joined).overlap().pairs, 0);
  EXPECT_EQ(describe(Simulation(joined).overlap(), joined), "");
  scene.grains[0].packing.positions[1].x() = 0.99;
  const InitialOverlap cohesive = Simulation(build_model(scene)).overlap();
  scene.contacts = {frictionless(100)};
  const InitialOverlap loose = Simulation(build_model(scene)).overlap();
  EXPECT_EQ(cohesive.pairs, 1);
  EXPECT_NEAR(cohesive.stored, loose.stored, 1e-14) << "of compression alone";
}

TEST(InitialOverlap, is_not_the_rounding_of_faces_that_touch) {  // EXACT
  const double far = 1e5;
  const Model model = build_model(with(box_shape("block", 0.3, 0.3, 0.1), {{far, 0}, {far + 0.3, 0}, {far + 0.6, 0}}));
  EXPECT_EQ(Simulation(model).overlap().pairs, 0);
}

}  // namespace
}  // namespace pliant::dynamics_tests
