// How deep contact sees, and that nothing gets lost on the way there.
#include <gtest/gtest.h>

#include <cmath>

#include "contact/deepest_node.hpp"
#include "core/errors.hpp"
#include "setup/build_model.hpp"
#include "support/contact_oracle.hpp"
#include "support/simulations.hpp"

namespace pliant {
namespace {

using namespace testing;

// INDEPENDENT: brute force without any limit of depth, down to a whole segment of the outlines.
TEST(ContactDepth, SeesAWholeSegmentDeep) {
  int compared = 0;
  double deepest = 0;
  for (int sample = 0; sample < 60; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 70);
    Scene scene = bare_scene();
    scene.contacts = {frictionless(100)};
    for (int i = 0; i < 2; ++i) {
      const Points outline = regular(30 + random.below(30), 1);
      add_body(scene, outline_shape("outline", outline), BodyKind::rigid, {0, 0}, random.uniform(0, 6));
    }
    ContactRig rig(scene);
    press_together(rig, random, random.uniform(0.05, 0.15));
    rig.evaluate();
    const ContactOracle::Result expected = ContactOracle(rig, scene.contacts[0]).evaluate();
    ASSERT_EQ(expected.outside_truth, 0);
    deepest = std::max(deepest, rig.totals.deepest);
    if (rig.totals.deepest > 1) continue;
    ++compared;
    EXPECT_EQ(rig.totals.contacts, expected.contacts);
    EXPECT_NEAR(rig.totals.stored, expected.stored, 1e-12);
  }
  EXPECT_GT(compared, 30);
  EXPECT_GT(deepest, 0.9);
}

// EXACT: beyond that it still sees, so that the engine can stop: up to one skin deeper.
TEST(ContactDepth, KnowsWhenItIsTooDeep) {
  for (const double depth : {1.02, 1.2, 1.45}) {
    Scene scene = bare_scene();
    scene.contacts = {frictionless(100)};
    add_body(scene, outline_shape("bar", rectangle(4, 2, 0.1)), BodyKind::rigid, {0, -1});
    add_body(scene, outline_shape("tip", {{0, 0}, {0.4, 1}, {-0.4, 1}}), BodyKind::rigid,
             {0.03, 2.0 / 3 - 0.1 * depth});
    ContactRig rig(scene);
    rig.evaluate();
    EXPECT_NEAR(rig.totals.deepest, depth, 1e-12);
  }
}

// EXACT: two flat walls that touch all along have each node in contact once, the one on the period's seam too.
TEST(ContactDepth, WallsAgainstEachOtherCountTheSeamOnce) {
  for (const double level : {0.0, 0.013}) {
    Scene scene = bare_scene();
    scene.period = 4;
    scene.contacts = {frictionless(100)};
    scene.walls = {flat_wall("floor", Wall::Solid::below, 0.02, 0.1), flat_wall("lid", Wall::Solid::above, 0, 0.1)};
    ContactRig rig(scene);
    rig.move(1, {level, 0});
    rig.step();
    EXPECT_EQ(rig.totals.contacts, rig.count(0) + rig.count(1));
    // Both passes of weight 1/2 along the whole period.
    EXPECT_NEAR(rig.force(1).y(), 100 * 0.02 * 4, 1e-12);
    EXPECT_NEAR(rig.totals.stored, 0.5 * 100 * 0.02 * 0.02 * 4, 1e-12);
  }
}

// EXACT: the walls' slip survives the seam's travel around the period and refreshes.
TEST(ContactDepth, WallsSlideThroughTheSeam) {
  Scene scene = bare_scene();
  scene.period = 4;
  scene.contacts = {mohr_coulomb(100, 0.3)};
  scene.walls = {flat_wall("floor", Wall::Solid::below, 0.02, 0.1), flat_wall("lid", Wall::Solid::above, 0, 0.1)};
  ContactRig rig(scene);
  rig.step();
  for (int step = 1; step <= 1000; ++step) {
    rig.move(1, {0.009, 0});
    rig.step();
    EXPECT_EQ(rig.totals.contacts, rig.count(0) + rig.count(1));
    if (step > 1) {
      ASSERT_NEAR(rig.force(1).x(), -0.3 * rig.force(1).y(), 1e-12) << "step " << step;
    }
  }
}

// EXACT: a start deeper than a segment is refused, one less deep is not; also where boxes overlap and bodies do not.
void expect_refused(const Scene& scene, bool refused) {
  const ContactRig rig(scene);
  if (refused)
    EXPECT_THROW(refuse_deep_overlap(rig.model, rig.outlines.position), InputError);
  else
    EXPECT_NO_THROW(refuse_deep_overlap(rig.model, rig.outlines.position));
}

TEST(InitialOverlap, DiscsAcrossThePeriod) {
  const double segment = 2 * std::sin(M_PI / 60);
  for (const double depth : {-0.1, 0.9 * segment, 1.1 * segment, 0.5, 1.9, 2.0}) {
    Scene scene = bare_scene();
    scene.period = 7;
    scene.contacts = {frictionless(100)};
    add_body(scene, outline_shape("disc", regular(60, 1)), BodyKind::rigid, {0.2, 0});
    add_body(scene, outline_shape("disc", regular(60, 1)), BodyKind::rigid, {0.2 + 2 - depth - 21, 0});
    expect_refused(scene, depth > segment);
  }
}

TEST(InitialOverlap, DiscInTheHollowOfAStar) {
  const Points hollow = refined({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 0.1);
  for (const double x : {1.5, 1.45, 1.2}) {
    Scene scene = bare_scene();
    scene.contacts = {frictionless(100)};
    const Vec2 centroid = polygon_properties(hollow).centroid;
    add_body(scene, outline_shape("star", hollow), BodyKind::rigid, centroid);
    add_body(scene, outline_shape("disc", regular(40, 0.45)), BodyKind::rigid, {x, 2});
    expect_refused(scene, x == 1.2);
  }
}

TEST(InitialOverlap, DiscBehindAWall) {
  for (const double y : {1.0, 0.95, 0.8, -5.0}) {
    Scene scene = bare_scene();
    scene.period = 4;
    scene.contacts = {frictionless(100)};
    add_body(scene, outline_shape("disc", regular(60, 1)), BodyKind::rigid, {7.3, y});
    scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 0.1), flat_wall("lid", Wall::Solid::above, 2.2, 0.1)};
    expect_refused(scene, y < 0.9);
  }
}

}  // namespace
}  // namespace pliant

namespace pliant::dynamics_tests {
namespace {

// A contact far too soft for its load must be noticed, whatever the integrator: never may a disc pass through a floor.
TEST(LostContact, StopsTheRun) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::step_doubling})
    for (const double speed : {3.0, 10.0, 100.0}) {
      Scene scene = on_a_floor(2, 4, 0.1, {0, 0});
      scene.time.integrator = integrator;
      scene.contacts = {frictionless(100)};
      scene.shapes = {polygonal_disc("disc", 2, 60)};
      scene.grains = {grains("disc", "disc", BodyKind::rigid, {{2, 1.2}}, moving({0, -speed}))};
      const Model model = build_model(scene);
      Simulation simulation(model);
      EXPECT_THROW(advance(simulation, 2), PhysicsError) << "speed " << speed;
      EXPECT_GT(rigid(simulation.state().position, 0)[1], 0.85) << "the last good state is still above the floor";
    }
}

}  // namespace
}  // namespace pliant::dynamics_tests
