#include <gtest/gtest.h>

#include <cmath>

#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr double lip_friction = 0.3;

/// Moves the node 0 of body 1 to a place and accepts the step.
void step_to(ContactRig& rig, const Vec2& place) {
  rig.move(1, place - rig.node(1, 0));
  rig.step();
}

/// A tip whose flanks and base touch nothing.
ShapeSpec pin(const Vec2& upwards) {
  const Vec2 across(upwards.y(), -upwards.x());
  return outline_shape("pin", {{0, 0}, 4 * upwards + 0.003 * across, 4 * upwards - 0.003 * across});
}

double tip_weight(const ContactRig& rig) { return 0.5 * rig.model.outlines[1].tributary_length[0]; }

// The side of a soft block beside its corner, folded by a disc that was pressed past it (a crease of the surface, 3
// degrees open): from the lower right, up, back down along the crease from (-0.09, 0.74), and up again over the thin
// lip.
const Points creased_corner{{4.2, -7.24},   {3.61, -4.9},   {2.58, -2.75}, {1.54, -0.743},
                            {-0.09, 0.737}, {1.15, -0.272}, {-1.1, 3.378}, {-4.07, 3.55},
                            {-6.05, 3.353}, {-9, 3.1},      {-9, -9},      {4.4, -9}};
const Vec2 lip = Vec2(-2.25, 3.65).normalized(), out_of_lip(lip.y(), -lip.x());

/// A place below the lip's outer face, by the distance from its edge.
Vec2 under_lip(const ContactRig& rig, double distance, double depth) {
  return rig.node(0, 5) + distance * lip - depth * out_of_lip;
}

Scene crease_scene() {
  Scene scene = nodal_scene();
  scene.contacts = {mohr_coulomb(kn, lip_friction)};
  add_body(scene, outline_shape("block", creased_corner), BodyKind::rigid, {0, 0});
  add_body(scene, pin(out_of_lip), BodyKind::rigid, {20, 20});
  return scene;
}

// EXACT: the lip's outer face is nearer to the tip than its others all the distance, by more than the square root of
// two
// that the tip's second side is worth, so the tip is pressed with kn times its depth
// along that face's normal and slides with friction. The bisector between the two faces of the lip leaves the tip to
// the lip's lower face, which ends before: by that the gap would jump between -0.45 and -1.1 or even to the outside.
TEST(FoldedOutline, TheNearestFaceCounts) {
  ContactRig rig(crease_scene());
  constexpr double depth = 0.45;
  rig.step();
  for (const double shallow : {-0.1, 0.1, 0.2, 0.3, 0.4}) step_to(rig, under_lip(rig, 3.8, shallow));
  for (double distance = 3.8; distance > 2.2; distance -= 0.02) {
    step_to(rig, under_lip(rig, distance, depth));
    const Vec2 force = rig.force(1, 0) / (tip_weight(rig) * kn * depth);
    EXPECT_NEAR(force.dot(out_of_lip), 1, 1e-12) << distance;
    EXPECT_LE(std::abs(force.dot(lip)), lip_friction + 1e-12) << distance;
  }
}

// EXACT: the same distance slid to and fro dissipates friction times pressure times length, less what it takes to
// turn the
// shear. Steps of 0.018 end where slip starts, 0.27 after the turn. Rounding of coordinates of order 10.
TEST(FoldedOutline, SlidingUnderALipDissipatesForceTimesWay) {
  ContactRig rig(crease_scene());
  constexpr double depth = 0.45, longest = 3.8, shortest = 2.18;
  const auto slide = [&](double from, double to) {
    for (int i = 1; i <= 90; ++i) step_to(rig, under_lip(rig, from + (to - from) * i / 90, depth));
  };
  rig.step();
  for (const double shallow : {-0.1, 0.1, 0.2, 0.3, 0.4}) step_to(rig, under_lip(rig, longest, shallow));
  slide(longest, shortest);
  rig.dissipated = 0;
  slide(shortest, longest);
  const double pressure = kn * depth, turn = 2 * lip_friction * depth;  // kt = kn
  EXPECT_NEAR(rig.dissipated, tip_weight(rig) * lip_friction * pressure * (longest - shortest - turn), 1e-10);
}

// EXACT: a tip that crosses a narrow slit at once, straight from beside one flank into the other, has slid along
// neither. The distance along the outline from the one to the other, around the bottom of the slit, is 0.82.
TEST(FoldedOutline, SlipDoesNotRunAroundASlit) {
  Scene scene = nodal_scene();
  scene.contacts = {mohr_coulomb(kn, lip_friction)};
  Points block;
  // Counter-clockwise: bottom, right side, top to the slit, down, up again, top.
  for (const Vec2& corner : {Vec2(-1, -2), Vec2(1, -2), Vec2(1, 0)}) block.push_back(corner);
  for (int i = 0; i <= 4; ++i) block.emplace_back(0.01, -0.25 * i);
  for (int i = 4; i >= 0; --i) block.emplace_back(-0.01, -0.25 * i);
  block.emplace_back(-1, 0);
  add_body(scene, outline_shape("block", block), BodyKind::rigid, {0, 0});
  add_body(scene, pin({0, 1}), BodyKind::rigid, {20, 20});
  ContactRig rig(scene);
  rig.step();
  const Vec2 mouth = 0.5 * (rig.node(0, 3) + rig.node(0, 12));
  for (double height = 1; height > -0.6; height -= 0.05) step_to(rig, mouth + Vec2(0.005, height));
  step_to(rig, mouth + Vec2(0.005, -0.6));
  EXPECT_EQ(rig.totals.contacts, 0);
  step_to(rig, mouth + Vec2(-0.04, -0.6));
  EXPECT_EQ(rig.totals.contacts, 1);
  EXPECT_LT(std::abs(rig.dissipated), 1e-14);
  // Of the pin's two sides the one that lies along the flank counts: half of its tip's length, half of that in this
  // pass.
  EXPECT_NEAR(rig.force(1, 0).x(), tip_weight(rig) * kn * 0.03, 1e-12);
}

}  // namespace
}  // namespace pliant
