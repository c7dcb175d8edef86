// A compliant body that closes on itself.
#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "support/contact_rig.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

/// A clamp about 2 in size, its slot 0.3 wide, that an initial velocity closes; nothing else is there.
Scene clamp(bool self_contact, double friction = 0) {
  Scene scene = empty_scene(4);
  ShapeSpec shape = box_shape("clamp", 2, 2, 0.13);
  shape.points = {{-1, -1}, {1, -1}, {1, -0.15}, {-0.4, -0.15}, {-0.4, 0.15}, {1, 0.15}, {1, 1}, {-1, 1}};
  scene.shapes = {shape};
  InitialVelocity closing = moving({0.1, 0.05}, 0.05);
  closing.gradient << 0, 0, 0, -0.35;
  scene.grains = {grains("clamp", "clamp", BodyKind::compliant, {{0, 0}}, closing)};
  scene.contacts = {friction > 0 ? rough(300, friction) : smooth(300)};
  scene.contact.self_contact = self_contact;
  scene.time.safety = 0.4;
  return scene;
}

/// Least width of the slot at its mouth, and what the books say meanwhile.
struct Closing {
  double width = 1e300, stored = 0, momentum = 0, balance = 0, dissipated = 0;
};

Closing close(const Scene& scene) {
  const Model model = build_model(scene);
  Simulation simulation(model);
  const OutlineShape& shape = model.outlines[model.bodies[0].outline];
  const auto node_at = [&](const Vec2& corner) {
    int nearest = 0;
    const Vec2 target = corner + shape.points[0] - Vec2(-1, -1);
    for (int k = 0; k < shape.count; ++k)
      if ((shape.points[k] - target).norm() < (shape.points[nearest] - target).norm()) nearest = k;
    return nearest;
  };
  const int low = node_at({1, -0.15}), high = node_at({1, 0.15});
  Closing result;
  while (simulation.state().time < scene.time.end) {
    simulation.step(scene.time.end);
    const Outlines& outlines = simulation.forces().outlines();
    const Vec2 from(outlines.x[low], outlines.y[low]), to(outlines.x[high], outlines.y[high]);
    result.width = std::min(result.width, (to - from).norm() * (to.y() > from.y() ? 1 : -1));
    if (simulation.state().steps % 10 != 0) continue;
    const Audit audit = simulation.audit();
    result.stored = std::max(result.stored, audit.energy.contact);
    result.momentum = std::max(result.momentum, audit.momentum_error);
    result.balance = std::max(result.balance, simulation.balance_error(audit.energy));
    result.dissipated = audit.energy.dissipated;
  }
  return result;
}

TEST(SelfContact, stops_the_jaws) {
  const Closing with = close(clamp(true)), without = close(clamp(false));
  EXPECT_LT(without.width, -0.1) << "they must meet, or this test says nothing";
  EXPECT_GT(with.width, -0.05) << "less than half of a segment";
  EXPECT_LT(with.width, 0);
  EXPECT_GT(with.stored, 1e-4);
  EXPECT_EQ(without.stored, 0);
  EXPECT_LT(with.momentum, 1e-12) << "EXACT: rounding of sums over 60 nodes, linear and angular";
  EXPECT_LT(with.balance, 1e-3) << "RATE: impacts at this safety keep some 2e-4 of the energy, docs/defaults.md";
}

TEST(SelfContact, with_friction) {
  const Closing with = close(clamp(true, 0.3));
  EXPECT_GT(with.dissipated, 1e-7);
  EXPECT_LT(with.momentum, 1e-12) << "EXACT";
  EXPECT_LT(with.balance, 1e-3) << "RATE";
}

/// EXACT: a body that is never near itself moves on, bit by bit, as if it could not touch itself.
TEST(SelfContact, changes_nothing_where_nothing_touches) {
  const auto final_positions = [](bool self_contact) {
    Scene scene = flight_and_impact(1e-2);
    scene.contact.self_contact = self_contact;
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 2);
    return simulation.state().position.compliant[5][0];
  };
  EXPECT_EQ(final_positions(true), final_positions(false));
}

/// EXACT: a body thinner than contact sees is refused.
TEST(SelfContact, refuses_thin_limbs) {
  Scene scene = clamp(true);
  scene.shapes[0].points = {{-1, 0}, {1, -0.25}, {1.1, 0.25}};  // a tip of 27 degrees
  scene.shapes[0].spacing = 0.1;
  const Model model = build_model(scene);
  EXPECT_THROW(Simulation{model}, InputError);
}

/// EXACT: jaws that were out of each other's sight at the start and overlap later press; the scene is not to blame.
TEST(SelfContact, an_overlap_later_is_a_contact) {
  testing::ContactRig rig(clamp(true));
  rig.step();
  ASSERT_TRUE(rig.contact.patches().empty());
  const Body& body = rig.model.bodies[0];
  for (int i = 0; i < rig.model.shape_of(body).nodes(); ++i) {
    const std::size_t at = rig.model.batches[body.batch].offset + 2 * i;
    const double x = rig.q.compliant[at][body.lane];
    const double y = rig.q.compliant[at + 1][body.lane];
    // 0.2 at the mouth, whose jaws are 0.15 from the middle.
    rig.q.compliant[at + 1][body.lane] -= std::copysign(0.14 * std::max(0.0, x + 0.4), y);
  }
  rig.step();
  EXPECT_GT(rig.totals.contacts, 0);
}

}  // namespace
}  // namespace pliant::dynamics_tests
