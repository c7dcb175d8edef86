#include <gtest/gtest.h>

#include <cmath>

#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

// A thin plate, top at y = 0, segments of 0.1, and a needle pointing down at it whose tip is at the given height.
Scene plate_and_needle(double thickness, double height, const ContactRule& rule,
                       ContactQuadrature quadrature = ContactQuadrature::automatic) {
  constexpr double x = 0.03;
  Scene scene = bare_scene();
  scene.contact.quadrature = quadrature;
  scene.contacts = {rule};
  add_body(scene, outline_shape("plate", rectangle(2, thickness, 0.1)), BodyKind::rigid, {0, -thickness / 2});
  const double low = height + 2.0 / 3 * 0.3;  // centroid of the triangle below
  add_body(scene, outline_shape("needle", {{0, 0}, {0.05, 0.3}, {-0.05, 0.3}}), BodyKind::rigid, {x, low});
  return scene;
}

// EXACT: a tip above a plate that is thinner than its segments are long is outside, whatever lies behind the plate.
TEST(ThinBodies, TipOutsideIsNotTakenForInside) {
  for (const double thickness : {0.01, 0.03, 0.06, 0.09})
    for (const double height : {0.001, 0.01, 0.02, 0.04, 0.08})
      for (const ContactRule& rule : {frictionless(100), mohr_coulomb(100, 0.3), cohesive(100, 0.02, 0.0005, 0.02)}) {
        ContactRig rig(plate_and_needle(thickness, height, rule));
        rig.evaluate();
        EXPECT_EQ(rig.totals.contacts, 0) << "thickness " << thickness << ", height " << height;
        EXPECT_EQ(rig.totals.stored, 0);
      }
}

// EXACT: inside, the nearer face pushes: kn times the depth times half of the tip's tributary length, upwards from the
// upper half.
TEST(ThinBodies, NearerFacePushes) {
  for (const double depth : {0.01, 0.02, 0.04, 0.05}) {
    ContactRig rig(plate_and_needle(0.06, -depth, frictionless(100), ContactQuadrature::nodes));
    rig.evaluate();
    EXPECT_EQ(rig.totals.contacts, 1);
    const double length = std::hypot(0.05, 0.3), up = depth < 0.03 ? depth : -(0.06 - depth);
    EXPECT_LT((rig.force(1) - Vec2(0, 0.5 * 100 * length * up)).norm(), 1e-13) << depth;
  }
}

// EXACT: a disc left of a wedge of 20 degrees whose tip comes down beside it is pushed to the left, by what lies below
// the wedge's left face: the tip is so thin that the same nodes are a third of a segment below its right one.
TEST(ThinBodies, FarFaceOfATipDoesNotPush) {
  const Points wedge = refined({{0, 0}, {0.35, 2}, {-0.35, 2}}, 0.1);
  for (double tip = 0.1; tip > 0.01; tip -= 0.004) {
    Scene scene = bare_scene();
    scene.contacts = {frictionless(100)};
    add_body(scene, outline_shape("wedge", wedge), BodyKind::rigid, {0, tip + 4.0 / 3});
    add_body(scene, outline_shape("disc", regular(36, 1)), BodyKind::rigid, {-1, 0});
    ContactRig rig(scene);
    rig.evaluate();
    EXPECT_LE(rig.force(1).x(), 0) << "tip at " << tip;
    // (0.35/2 (0.1736 - 0.012) - 0.0152) cos 10, in segments of 0.0967: the disc's node at 10 degrees. Below the right
    // face: 0.3 to 0.45.
    EXPECT_LT(rig.totals.deepest, 0.134) << "tip at " << tip;
  }
}

// EXACT: beside a pointed body of 20 degrees, 0.001 off its flank, nothing touches.
TEST(ThinBodies, FlanksOfAWedgeAreApart) {
  const double half = 10 * M_PI / 180;
  const Points wedge = refined({{0, 0}, {-std::cos(half), std::sin(half)}, {-std::cos(half), -std::sin(half)}}, 0.1);
  for (int step = 1; step < 19; ++step) {
    Scene scene = bare_scene();
    scene.contacts = {frictionless(100)};
    const Vec2 centroid = polygon_properties(wedge).centroid;
    add_body(scene, outline_shape("wedge", wedge), BodyKind::rigid, centroid);
    const double s = -0.05 * step;
    const Vec2 tip(s * std::cos(half) + 0.001 * std::sin(half), -s * std::sin(half) + 0.001 * std::cos(half));
    add_body(scene, outline_shape("needle", {{0, 0}, {0.01, 0.3}, {-0.01, 0.3}}), BodyKind::rigid, tip + Vec2(0, 0.2));
    ContactRig rig(scene);
    rig.evaluate();
    EXPECT_EQ(rig.totals.contacts, 0) << "step " << step;
  }
}

}  // namespace
}  // namespace pliant
