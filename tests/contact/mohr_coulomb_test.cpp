// Strength of Mohr-Coulomb contacts: a flat block on a bar, pulled off and sheared.
#include <gtest/gtest.h>

#include <cmath>

#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr double bar_friction = 0.4, cohesion = 0.3, tension = 0.5, spacing = 0.1, length = 1.1;

// The block's ends stand midway between nodes of the bar, whose nodes below it have its length in all. They stay there
// within +-0.04.
Scene strong_block_on_bar() {
  Scene scene = nodal_scene();
  scene.contacts = {mohr_coulomb(kn, bar_friction, cohesion, tension)};
  add_body(scene, outline_shape("bar", rectangle(4, 1, spacing)), BodyKind::rigid, {0, -0.5});
  add_body(scene, outline_shape("block", rectangle(length, 0.5, spacing)), BodyKind::rigid, {0, 0.25});
  return scene;
}

// Of contact, half of it in either pass: 12 nodes of the block, of which those at the corners stand for half of a
// side's segment, and 11 of the bar.
constexpr double touching = 0.5 * (12 + 11) * spacing;

// Traction on the block, to the right and upwards, Pa: of its face, or of a node within it.
struct Tractions {
  Vec2 face{0, 0};
  std::vector<Vec2> inner;
};

Tractions tractions(const ContactRig& rig) {
  Tractions result;
  result.face = rig.force(1) / touching;
  for (int k = 0; k < rig.count(1); ++k) {
    const Vec2 from_middle = rig.node(1, k) - Vec2(rig.node(1, 0) + Vec2(length / 2, 0));
    if (std::abs(from_middle.y()) < 0.01 && std::abs(from_middle.x()) < 0.29)
      result.inner.push_back(rig.force(1, k) / spacing);
  }
  EXPECT_EQ(result.inner.size(), 6U);
  return result;
}

// The block `gap` above the bar, then pulled to the right by `distance`, in steps that are accepted.
Tractions pulled(double gap, double distance) {
  ContactRig rig(strong_block_on_bar());
  rig.move(1, {0, gap});
  rig.step();
  for (int step = 0; step < 10; ++step) {
    rig.move(1, {distance / 10, 0});
    rig.step();
  }
  return tractions(rig);
}

constexpr double cut_off_gap = tension / kn;

// EXACT: tension grows to the cut-off and is gone beyond it.
Vec2 when_pulled_off(double gap) { return {0, gap < cut_off_gap ? -kn * gap : 0}; }

// EXACT: c and the share mu of a pressure, none of a tension; nothing beyond the cut-off.
Vec2 when_sheared(double gap) {
  const double shear = gap < cut_off_gap ? cohesion + bar_friction * kn * std::max(-gap, 0.0) : 0;
  return when_pulled_off(gap) - Vec2(shear, 0);
}

constexpr double gaps[] = {-0.01, -0.002, 0.001, 0.003, 0.999 * cut_off_gap, 1.001 * cut_off_gap};
constexpr double far = 0.035;  ///< (c + mu p)/kt is 0.007 at most
constexpr double traction_rounding = 1e-12;

TEST(MohrCoulomb, strength_of_nodes_within_a_face) {
  for (const double gap : gaps) {
    for (const Vec2& t : pulled(gap, 0).inner) EXPECT_LT((t - when_pulled_off(gap)).norm(), traction_rounding) << gap;
    for (const Vec2& t : pulled(gap, far).inner) EXPECT_LT((t - when_sheared(gap)).norm(), traction_rounding) << gap;
  }
}

TEST(MohrCoulomb, strength_of_a_face_is_that_of_its_length) {
  for (const double gap : gaps) {
    EXPECT_LT((pulled(gap, 0).face - when_pulled_off(gap)).norm(), traction_rounding) << gap;
    EXPECT_LT((pulled(gap, far).face - when_sheared(gap)).norm(), traction_rounding) << gap;
  }
}

// EXACT: what shear has done by the end is the slip beyond the elastic one, times the strength.
TEST(MohrCoulomb, cohesion_works_without_pressure) {
  ContactRig rig(strong_block_on_bar());
  rig.move(1, {0, 0.001});
  rig.step();
  for (int step = 0; step < 50; ++step) {
    rig.move(1, {far / 50, 0});
    rig.step();
  }
  const double touching = -rig.force(1).x() / cohesion;  // length that carries its cohesion
  // Radial return works with the mean of two tractions, of which the first step beyond the limit sees one below it:
  // half a step of the limit.
  EXPECT_NEAR(rig.dissipated / touching, cohesion * (far - cohesion / kn), cohesion * far / 50);
}

}  // namespace
}  // namespace pliant
