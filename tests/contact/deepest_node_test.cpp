// The search for messages: which node of which body is deepest in which other.
#include "contact/deepest_node.hpp"

#include <gtest/gtest.h>

#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "setup/build_model.hpp"
#include "support/bench.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

DeepestNode deepest_in(const Scene& scene) {
  const Bench bench(scene);
  std::vector<BodyPair> pairs;
  for (const ContactPair& contact_pair : bench.forces.contact().contact_pairs())
    pairs.push_back({contact_pair.first, contact_pair.second, contact_pair.images});
  return deepest_node(bench.model, bench.state.outlines.position, pairs);
}

/// Three blocks in a row, the last pair with more overlap; the corner of one in the side of the other.
TEST(DeepestNode, names_the_pair_the_node_and_the_depth) {
  Scene scene = empty_scene(1);
  scene.shapes = {box_shape("block", 1, 1, 0.1)};
  scene.grains = {grains("blocks", "block", BodyKind::rigid, {{0, 0}, {0.99, 0.02}, {1.95, 0.53}})};
  const DeepestNode deepest = deepest_in(scene);
  EXPECT_EQ(std::min(deepest.slave, deepest.master), 1) << "EXACT";
  EXPECT_EQ(std::max(deepest.slave, deepest.master), 2) << "EXACT";
  EXPECT_NEAR(deepest.depth, 0.04, 1e-12) << "EXACT: overlap";
  EXPECT_NEAR(deepest.segment_length, 0.1, 1e-12) << "EXACT";
  EXPECT_NEAR(deepest.position.x(), deepest.slave == 1 ? 1.49 : 1.45, 1e-12) << "EXACT";
}

/// A block on another, whose nodes stand closer along it than they did.
TEST(DeepestNode, knows_how_far_the_segment_is_squeezed) {
  Scene scene = empty_scene(1);
  scene.shapes = {box_shape("block", 1, 1, 0.1)};
  scene.grains = {grains("lower", "block", BodyKind::rigid, {{0, 0}}),
                  grains("upper", "block", BodyKind::rigid, {{0, 0.98}})};
  const Model model = build_model(scene);
  OutlineField outlines = placed_outlines(model, initial_positions(model));
  for (int k = model.outline_offset[0]; k < model.outline_offset[1]; ++k) outlines.x[k] *= 0.3;
  const DeepestNode deepest = deepest_node(model, outlines, {{0, 1, {0}}});
  EXPECT_NEAR(deepest.depth, 0.02, 1e-12) << "EXACT: overlap";
  EXPECT_EQ(deepest.master, 0) << "EXACT: deeper over its shorter segments";
  EXPECT_NEAR(deepest.squeeze, 0.3, 1e-12) << "EXACT";
}

/// A disc astride the edge of the period, in a wall: the same as away from it.
TEST(DeepestNode, does_not_see_the_period) {
  for (const double x : {4.0, 0.0, 7.9, 23.7}) {
    Scene scene = on_a_floor(8, 8, 0.25, {0, 0});
    scene.shapes = {disc_shape("disc", 2, 60)};
    scene.grains = {grains("disc", "disc", BodyKind::rigid, {{x, 0.95}})};
    const DeepestNode deepest = deepest_in(scene);
    EXPECT_EQ(deepest.slave + deepest.master, 1) << "EXACT";
    EXPECT_GT(deepest.depth, 0.04) << "EXACT: overlap 0.05, less what the polygon's lowest node may miss";
    EXPECT_LT(deepest.depth, 0.055);
  }
}

/// Discs that touch nowhere have no node inside, and the sharp corner of a thin triangle sees none behind its tip.
TEST(DeepestNode, outside_is_not_inside) {
  Scene scene = empty_scene(1);
  ShapeSpec needle = box_shape("needle", 1, 1, 1);
  needle.points = {{-0.6, -0.05}, {1.2, 0}, {-0.6, 0.05}};
  scene.shapes = {needle, disc_shape("disc", 2, 60)};
  scene.skin = 3;
  scene.grains = {grains("needle", "needle", BodyKind::rigid, {{0, 0}}),
                  grains("disc", "disc", BodyKind::rigid, {{2.25, 0}})};
  EXPECT_EQ(deepest_in(scene).depth, 0) << "EXACT";
}

}  // namespace
}  // namespace pliant::dynamics_tests
