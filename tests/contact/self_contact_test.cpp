// A compliant body that closes on itself.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "contact/deepest_node.hpp"
#include "core/errors.hpp"
#include "setup/build_model.hpp"
#include "support/contact_rig.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

/// A clamp about 2 in size, its slot 0.3 wide, that an initial velocity closes; nothing else is there.
Scene clamp(bool self_contact, double friction = 0, double safety = 0.4) {
  Scene scene = empty_scene(4);
  ShapeSpec shape = box_shape("clamp", 2, 2, 0.13);
  shape.points = {{-1, -1}, {1, -1}, {1, -0.15}, {-0.4, -0.15}, {-0.4, 0.15}, {1, 0.15}, {1, 1}, {-1, 1}};
  scene.shapes = {shape};
  InitialVelocity closing = moving({0.1, 0.05}, 0.05);
  closing.gradient << 0, 0, 0, -0.35;
  scene.grains = {grains("clamp", "clamp", BodyKind::compliant, {{0, 0}}, closing)};
  scene.contacts = {friction > 0 ? mohr_coulomb(300, friction) : frictionless(300)};
  scene.contact.self_contact = self_contact;
  scene.time.safety = safety;
  return scene;
}

/// Least width of the slot at its mouth, and what the energy balance say meanwhile.
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
    const OutlineField& outlines = simulation.state().outlines.position;
    const Vec2 from = outlines.at(low), to = outlines.at(high);
    result.width = std::min(result.width, (to - from).norm() * (to.y() > from.y() ? 1 : -1));
    if (simulation.state().steps % 10 != 0) continue;
    const EnergyBalance audit = simulation.energy_balance();
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
  EXPECT_LT(with.balance, 1e-3) << "RATE: impacts at this safety keep some 2e-4 of the energy, docs/notes/impacts.md";
}

TEST(SelfContact, with_friction) {
  const Closing with = close(clamp(true, 0.3));
  EXPECT_GT(with.dissipated, 1e-7);
  EXPECT_LT(with.momentum, 1e-12) << "EXACT";
  EXPECT_LT(with.balance, 1e-2) << "EXACT: what a run warns of";
  EXPECT_LT(close(clamp(true, 0.3, 0.1)).balance, 1e-2 / 16) << "RATE: second order in a fourth of the step";
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

/// EXACT: a body thinner than contact sees is refused, at nodes; over segments its medial axis is known, and nothing
/// touches.
TEST(SelfContact, refuses_thin_limbs) {
  Scene scene = clamp(true);
  scene.shapes[0].points = {{-1, 0}, {1, -0.25}, {1.1, 0.25}};  // a tip of 27 degrees
  scene.shapes[0].spacing = 0.1;
  {
    const Model model = build_model(scene);
    Simulation simulation(model);
    EXPECT_EQ(simulation.energy_balance().energy.contact, 0);
  }
  scene.contact.quadrature = ContactQuadrature::nodes;
  const Model model = build_model(scene);
  EXPECT_THROW(Simulation{model}, InputError);
}

/// EXACT: jaws that were out of each other's sight at the start and overlap later press; the scene is not to blame.
TEST(SelfContact, an_overlap_later_is_a_contact) {
  Scene scene = clamp(true);
  scene.contact.quadrature = ContactQuadrature::nodes;  // over segments the deepest place may be between nodes
  testing::ContactRig rig(scene);
  rig.step();
  ASSERT_TRUE(rig.contact.contact_pairs().empty());
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
  const DeepestNode deepest = deepest_contact(rig.model, rig.outlines, rig.contact);
  EXPECT_TRUE(deepest.of_itself);
  const double longest = rig.model.outlines[rig.model.bodies[0].outline].spacing;
  EXPECT_GE(deepest.depth / deepest.segment_length, rig.totals.deepest)
      << "EXACT: over a segment, not the longest near";
  EXPECT_LT(deepest.depth, 1.2 * rig.totals.deepest * longest);
}

/// EXACT: jaws that pass through each other, their contact far too soft, are what the message names.
TEST(SelfContact, that_is_lost_is_named) {
  Scene scene = clamp(true);
  scene.contacts = {frictionless(0.1)};
  scene.grains[0].velocity.gradient *= 3;
  const Model model = build_model(scene);
  Simulation simulation(model);
  std::string message;
  try {
    advance(simulation, scene.time.end);
  } catch (const PhysicsError& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("contact of body 0 'clamp' with itself is lost: outline node"), std::string::npos) << message;
}

/// A turn about the origin and a shift.
struct RigidMotion {
  double turn = 0;
  Vec2 shift{0, 0};
  Vec2 operator()(const Vec2& x) const { return Eigen::Rotation2Dd(turn) * x + shift; }
};

/// The clamp, of finite elements, whose nodes stand on the outline itself; and its jaws as rigid bodies of the same
/// outline nodes.
class Jaws {
 public:
  static constexpr double cut = -0.3;  ///< jaws begin to the right of it

  explicit Jaws(ContactQuadrature quadrature)
      : clamp_(clamp_of_elements(quadrature)), apart_(jaws_alone(clamp_, quadrature)) {
    for (int jaw : {0, 1}) {
      apart_.move(jaw, clamp_.node(0, nodes_[jaw][0]) - apart_.node(jaw, 0));
      rest_.emplace_back(apart_.rigid(jaw)[0], apart_.rigid(jaw)[1]);
    }
    clamp_nodes_ = clamp_.q;
    step();
  }
  void move(const RigidMotion (&motion)[2]) {
    const Body& body = clamp_.model.bodies[0];
    const std::size_t offset = clamp_.model.batches[body.batch].offset;
    for (int i = 0; i < clamp_.model.shape_of(body).nodes(); ++i) {
      const std::size_t at = offset + 2 * static_cast<std::size_t>(i);
      const Vec2 X(clamp_nodes_.compliant[at][body.lane], clamp_nodes_.compliant[at + 1][body.lane]);
      if (X.x() < cut + root(clamp_)) continue;
      const Vec2 x = motion[X.y() > 0](X);
      clamp_.q.compliant[at][body.lane] = x.x(), clamp_.q.compliant[at + 1][body.lane] = x.y();
    }
    for (int jaw : {0, 1}) {
      const Vec2 x = motion[jaw](rest_[jaw]);
      double* position = apart_.rigid(jaw);
      position[0] = x.x(), position[1] = x.y(), position[2] = motion[jaw].turn;
    }
    step();
  }
  /// Compares the forces on the jaws' nodes, those near the cut aside. Returns how many of them push.
  int expect_same_forces() const {
    int pushing = 0;
    for (int jaw : {0, 1})
      for (std::size_t i = 0; i < nodes_[jaw].size(); ++i) {
        const int k = nodes_[jaw][i];
        if (clamp_.model.outlines[0].points[k].x() < 0.2 + root(clamp_)) continue;
        const Vec2 expected = apart_.force(jaw, static_cast<int>(i));
        EXPECT_LT((clamp_.force(0, k) - expected).norm(), 1e-12) << "EXACT: rounding, node " << k;
        pushing += expected.norm() > 0.01;
      }
    return pushing;
  }
  double dissipated() const { return apart_.dissipated; }

 private:
  static Scene clamp_of_elements(ContactQuadrature quadrature) {
    Scene scene = clamp(true, 0.3);
    scene.contact.quadrature = quadrature;
    scene.discretisation.method = DiscretisationMethod::es_t3;
    return scene;
  }
  /// Where the clamp's own x = 0 has come to: outlines stand about their centre of area.
  static double root(const testing::ContactRig& rig) { return rig.model.outlines[0].points[0].x() + 1; }
  Scene jaws_alone(const testing::ContactRig& rig, ContactQuadrature quadrature) {
    Scene scene = testing::bare_scene();
    scene.contact.quadrature = quadrature;
    scene.contacts = {testing::mohr_coulomb(300, 0.3)};
    const Points& outline = rig.model.outlines[0].points;
    for (int jaw : {0, 1}) {
      Points points;
      for (int k = 0; k < static_cast<int>(outline.size()); ++k)
        if (outline[k].x() > cut + root(rig) && (outline[k].y() > 0) == (jaw == 1))
          points.push_back(outline[k]), nodes_[jaw].push_back(k);
      // The cut in segments as long as the others: contact looks as far as the longest.
      const Vec2 from = points.back(), to = points.front();
      const int cuts = static_cast<int>(std::ceil((to - from).norm() / 0.13));
      for (int i = 1; i < cuts; ++i) points.push_back(from + static_cast<double>(i) / cuts * (to - from));
      testing::add_body(scene, testing::outline_shape("jaw", points), BodyKind::rigid, {0, 0});
    }
    return scene;
  }
  void step() { clamp_.step(), apart_.step(); }

  std::vector<int> nodes_[2];  ///< [jaws]: numbers of their nodes on the clamp's outline
  testing::ContactRig clamp_, apart_;
  Points rest_;
  Dofs clamp_nodes_;
};

/// EXACT: the flanks of one body press and rub each other as two bodies do that have those flanks.
TEST(SelfContact, forces_are_those_between_two_bodies) {
  for (const ContactQuadrature quadrature : {ContactQuadrature::nodes, ContactQuadrature::segments}) {
    Jaws jaws(quadrature);
    EXPECT_EQ(jaws.expect_same_forces(), 0) << "apart";
    // Closed by 0.32 of 0.3, not quite in parallel; then they slide along each other and open again.
    for (const double slide : {0.0, 0.01, 0.02, 0.01, -0.02, -0.03}) {
      jaws.move({{0.01, {slide, 0.16}}, {-0.007, {-0.5 * slide, -0.158 + 0.1 * slide}}});
      EXPECT_GT(jaws.expect_same_forces(), 8) << "slide " << slide;
    }
    // Over segments slip is that of steps, which this rig does not tell of.
    if (quadrature == ContactQuadrature::nodes) EXPECT_GT(jaws.dissipated(), 1e-5);
  }
}

}  // namespace
}  // namespace pliant::dynamics_tests
