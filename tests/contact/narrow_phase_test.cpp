#include "contact/narrow_phase.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/polygon.hpp"
#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - s * (b - a)).norm();
}

// Is entry `index` of a closed outline, or of a wall's endless line, among [begin, begin + count)?
bool holds(const OutlineShape& shape, int begin, int count, int index) {
  if (shape.turn_shift != 0) return index >= begin && index < begin + count;
  const int n = shape.count;
  return ((index - begin) % n + n) % n < count;
}

struct Pair {
  const ContactRig& rig;
  BodyPair bodies;
  double margin;
  ContactPair contact_pair;

  Pair(const ContactRig& r, const BodyPair& b, double m) : rig(r), bodies(b), margin(m) {
    contact_pair.first = b.first, contact_pair.second = b.second, contact_pair.images = b.images;
    MasterWindow scratch;
    find_arcs(rig.model, rig.outlines.position, contact_pair, margin, 0.5 * margin, scratch);
  }
  int body(int side) const { return side == 0 ? bodies.first : bodies.second; }
  const OutlineShape& shape(int side) const { return rig.model.outlines[rig.model.bodies[body(side)].outline]; }
  Vec2 node(int side, int k) const {
    const int n = shape(side).count, turn = turn_of(k, n);
    const double shift = side == 0 ? 0 : rig.outlines.position.lattice.shift(bodies.images).x();
    return rig.node(body(side), k - turn * n) + Vec2(shift + turn * shape(side).turn_shift, 0);
  }
};

// docs/method.md 4: no contact may be missed. A node within the margin of a segment must be among its side's nodes, and
// the segment among the other's.
int missed(const Pair& pair, int turns) {
  int result = 0;
  for (int side = 0; side < 2; ++side) {
    const int n = pair.shape(side).count, m = pair.shape(1 - side).count;
    const bool wall_slave = pair.shape(side).turn_shift != 0, wall_master = pair.shape(1 - side).turn_shift != 0;
    for (int k = wall_slave ? -turns * n : 0; k < (wall_slave ? turns * n : n); ++k)
      for (int s = wall_master ? -turns * m : 0; s < (wall_master ? turns * m : m); ++s) {
        const double distance =
            distance_to_segment(pair.node(side, k), pair.node(1 - side, s), pair.node(1 - side, s + 1));
        if (distance > pair.margin * (1 - 1e-12)) continue;
        const Arc &own = pair.contact_pair.nodes[side], &other = pair.contact_pair.segments[1 - side];
        result += !holds(pair.shape(side), own.begin, own.count, k) ||
                  !holds(pair.shape(1 - side), other.begin, other.count, s);
      }
  }
  return result;
}

Points coarse_outline(Random& random, int kind) {
  if (kind == 5) return random_convex(random, 3 + random.below(3), 1, 0.8);  // edges as long as the body
  if (kind == 6) return random_star(random, 5 + random.below(6), 0.3);
  return random_outline(random, kind);
}

// EXACT: brute force over all nodes and segments.
TEST(NarrowPhase, MissesNothingOnRandomOutlines) {
  int near = 0;
  for (int sample = 0; sample < 3000; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 11);
    Scene scene = bare_scene();
    scene.contacts = {frictionless(1)};
    for (int i = 0; i < 2; ++i) {
      const Points outline = coarse_outline(random, random.below(7));
      add_body(scene, outline_shape("outline", outline), BodyKind::rigid, {0, 0}, random.uniform(0, 6));
    }
    ContactRig rig(scene);
    press_together(rig, random, random.uniform(-0.1, 0.1));
    const Pair pair(rig, {0, 1, {0}}, random.uniform(0.01, 0.15));
    near += pair.contact_pair.nodes[0].count > 0;
    EXPECT_EQ(missed(pair, 0), 0);
  }
  EXPECT_GT(near, 1500);
}

// EXACT: the same across the period and against walls with asperities, seen from bodies several periods away.
TEST(NarrowPhase, MissesNothingOnWallsAndAcrossThePeriod) {
  for (int sample = 0; sample < 60; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 900);
    Scene scene = bare_scene();
    scene.period = 5;
    scene.contacts = {frictionless(1)};
    const double x = random.uniform(-7, 7);
    add_body(scene, polygonal_disc("disc", 2, 20 + random.below(30)), BodyKind::rigid, {x, 1.2}, 1);
    add_body(scene, outline_shape("outline", random_outline(random, random.below(4))), BodyKind::rigid,
             {x + 2 - 10, 1.5}, 2);
    scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 0.2), flat_wall("lid", Wall::Solid::above, 2.3, 0.2)};
    scene.walls[0].asperities = Asperities{0.8, 5, 0.3, {0}, {random.uniform(0.4, 1.2)}};
    const ContactRig rig(scene);
    const double margin = random.uniform(0.05, 0.2);
    EXPECT_EQ(missed(Pair(rig, {0, 1, {2}}, margin), 0), 0);
    for (int body = 0; body < 2; ++body)
      for (int wall = 2; wall < 4; ++wall) EXPECT_EQ(missed(Pair(rig, {body, wall, {0}}, margin), 5), 0);
  }
}

// The purpose: two discs that touch look at a small part of their outlines only.
TEST(NarrowPhase, ArcsAreShort) {
  Scene scene = bare_scene();
  scene.contacts = {frictionless(1)};
  for (int i = 0; i < 2; ++i) add_body(scene, polygonal_disc("disc", 2, 100), BodyKind::rigid, {1.99 * i, 0.3 * i});
  const ContactRig rig(scene);
  const Pair pair(rig, {0, 1, {0}}, 0.05);
  for (int side = 0; side < 2; ++side)
    for (const Arc& arc : {pair.contact_pair.nodes[side], pair.contact_pair.segments[side]}) {
      EXPECT_GT(arc.count, 5);
      EXPECT_LT(arc.count, 15);
    }
}

// EXACT: bodies further apart than the margin get no arcs.
TEST(NarrowPhase, NothingBetweenBodiesApart) {
  Scene scene = bare_scene();
  scene.contacts = {frictionless(1)};
  for (int i = 0; i < 2; ++i) add_body(scene, polygonal_disc("disc", 2, 100), BodyKind::rigid, {2.2 * i, 0});
  const ContactRig rig(scene);
  const Pair pair(rig, {0, 1, {0}}, 0.05);
  for (int side = 0; side < 2; ++side) {
    EXPECT_EQ(pair.contact_pair.nodes[side].count, 0);
    EXPECT_EQ(pair.contact_pair.segments[side].count, 0);
  }
}

}  // namespace
}  // namespace pliant
