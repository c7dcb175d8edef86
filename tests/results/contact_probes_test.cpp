// What probes tell of contacts, against the oracle, brute force and closed forms.
#include <gtest/gtest.h>

#include <numbers>

#include "contact/contact_points.hpp"
#include "results/frame_fields.hpp"
#include "setup/build_model.hpp"
#include "support/contact_oracle.hpp"
#include "support/probing.hpp"

namespace pliant {
namespace {

using testing::ContactOracle;
using testing::ContactRig;
using testing::Random;

/// Two random bodies pressed together and moved past each other in small steps: sticking and slipping nodes.
class InspectedPair : public ::testing::TestWithParam<int> {};

TEST_P(InspectedPair, agrees_with_the_oracle) {
  Random random(static_cast<unsigned>(70 + GetParam()));
  Scene scene = testing::nodal_scene();
  const ContactRule rule =
      GetParam() % 2 == 0 ? testing::mohr_coulomb(20, 0.3) : testing::cohesive(20, 0.02, 0.01, 0.02);
  scene.contacts = {rule};
  for (int body = 0; body < 2; ++body)
    testing::add_body(scene, testing::outline_shape("", testing::random_outline(random, 4 * (GetParam() % 3 > 0))),
                      BodyKind::rigid, {0, 0});
  ContactRig rig(scene);
  testing::press_together(rig, random, 0.02);
  ContactOracle oracle(rig, rule);
  for (int step = 0; step < 10; ++step) {
    rig.step();
    const ContactOracle::Result expected = oracle.evaluate();
    oracle.commit();
    Vec2 force[2] = {{0, 0}, {0, 0}};
    double deepest = 0, stored = 0;
    int count = 0;
    for (const TouchingPair& pair : inspect_contacts(rig.model, rig.contact, rig.outlines, rig.committed))
      for (const ContactPoint& p : pair.points) {
        const Vec2 tangent(-p.normal.y(), p.normal.x());
        const Vec2 f = 0.5 * p.length * (p.pressure * p.normal + p.shear * tangent);
        force[p.slave] += f, force[p.master] -= f;
        deepest = std::max(deepest, -p.gap), ++count;
        stored += 0.5 * p.length * 0.5 * 20 * p.slip * p.slip;
        EXPECT_NEAR(p.shear, -20 * p.slip, 1e-13) << "EXACT: kt = kn";
      }
    EXPECT_EQ(count, expected.contacts) << "INDEPENDENT";
    EXPECT_NEAR(deepest, expected.deepest, 1e-13) << "INDEPENDENT";
    for (int body = 0; body < 2; ++body) {
      Vec2 sum(0, 0);
      for (const Vec2& f : expected.force[body]) sum += f;
      EXPECT_NEAR((force[body] - sum).norm(), 0, 1e-12) << "INDEPENDENT: the oracle's forces";
    }
    if (step == 1) EXPECT_GT(stored, 0) << "some shear is stored";
    rig.move(1, {0.001, 0.0007});
  }
}
INSTANTIATE_TEST_SUITE_P(Bodies, InspectedPair, ::testing::Range(0, 6));

}  // namespace
}  // namespace pliant

namespace pliant::dynamics_tests {
namespace {

/// A rigid block of 1 x 0.5, `depth` inside a floor; its sides are divided by 0.1.
Scene block_on_floor(double depth) {
  Scene scene = on_a_floor(1, 4, 0.1, {0, 0});
  scene.shapes = {box_shape("block", 1, 0.5, 0.1)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{2, 0.25 - depth}})};
  scene.contacts = {mohr_coulomb(100, 0.3)};
  scene.contact.quadrature = ContactQuadrature::nodes;
  return scene;
}

TEST(ContactProbes, block_on_a_floor) {
  const Model model = build_model(block_on_floor(0.004));
  Simulation simulation(model);
  const Points& points = model.outlines[model.bodies[0].outline].points;
  const int touching =
      static_cast<int>(std::count_if(points.begin(), points.end(), [](const Vec2& p) { return p.y() < -0.249; }));
  EXPECT_NEAR(measured(simulation, probe_of("contact_gap", "block"))[0], -0.004, 1e-15) << "EXACT";
  EXPECT_NEAR(measured(simulation, probe_of("contact_pressure", "block"))[0], 0.4, 1e-13) << "EXACT: kn depth";
  EXPECT_EQ(measured(simulation, probe_of("contact_slip", "block"))[0], 0) << "EXACT: nothing moved";
  const Vec2 contacts = measured_vector(simulation, probe_of("contacts", "block"));
  EXPECT_EQ(contacts, Vec2(1, touching)) << "EXACT";
  EXPECT_NEAR(measured(simulation, probe_of("contact_length", "block"))[0], 1.1, 1e-13) << "EXACT: 11 nodes";
  EXPECT_NEAR(measured(simulation, at_node(0, probe_of("contact_gap", "block")))[0], points[0].y() < 0 ? -0.004 : NAN,
              1e-15)
      << "EXACT";
  const std::vector<double> fabric = measured(simulation, probe_of("fabric", "block"));
  EXPECT_NEAR(fabric[2], 1, 1e-15) << "EXACT: all normals are upright";
  EXPECT_NEAR(fabric[3], 1, 1e-15) << "EXACT";
  EXPECT_NEAR(std::abs(fabric[4]), std::numbers::pi / 2, 1e-15) << "EXACT";
}

TEST(ContactProbes, partners_select) {
  Scene scene = block_on_floor(0.004);
  scene.grains.push_back(grains("upper", "block", BodyKind::rigid, {{2.05, 0.75 - 0.006}}));
  const Model model = build_model(scene);
  Simulation simulation(model);
  const auto with = [&](const char* quantity, const char* of, const char* partner) {
    Probe probe = probe_of(quantity, of);
    probe.with = partner;
    return measured(simulation, probe)[0];
  };
  EXPECT_NEAR(with("contact_gap", "block", "floor"), -0.004, 1e-15) << "EXACT";
  EXPECT_NEAR(with("contact_gap", "block", "upper"), -0.002, 1e-15) << "EXACT";
  EXPECT_NEAR(with("contact_gap", "block", "rigid"), -0.002, 1e-15) << "EXACT: the floor is no grain";
  EXPECT_TRUE(std::isnan(with("contact_gap", "upper", "floor"))) << "EXACT: apart";
  EXPECT_EQ(with("contacts", "all", ""), 2) << "EXACT";
  EXPECT_EQ(with("contacts", "upper", "floor"), 0) << "EXACT";
  EXPECT_EQ(with("contacts", "floor", ""), 1) << "EXACT";
  const std::vector<double> coordination = measured(simulation, probe_of("coordination", "all"));
  EXPECT_EQ(coordination, (std::vector<double>{1.5, 2, 0.5})) << "EXACT: the lower touches two, the upper rattles";
}

/// EXACT: a block over the seam of a period, its nodes on those of two walls: each carries kn times the depth over its
/// length, the nodes beside the seam as well. The lower wall runs one way, the upper one the other.
TEST(ContactProbes, tractions_of_walls_go_on_across_the_period) {
  Scene scene = block_on_floor(0.004);
  scene.grains[0].packing.positions = {{0, 0.246}};
  scene.walls.push_back(flat_wall("lid", Wall::Solid::above, 0.492, 0.1));
  const Model model = build_model(scene);
  Simulation simulation(model);
  const Snapshot snapshot(simulation);
  const std::vector<double> pressure = outline_field("contact_pressure")(snapshot),
                            shear = outline_field("contact_shear")(snapshot);
  const OutlineField& o = snapshot.outlines();
  int pressed = 0;
  for (int wall : {1, 2})
    for (int i = model.outline_offset[wall]; i < model.outline_end(wall); ++i) {
      if (std::abs(std::remainder(o.x[i], 4)) > 0.25) continue;  // the last two before the corners of the block
      EXPECT_NEAR(pressure[i], 0.4, 1e-12) << "x = " << o.x[i] << ", wall " << wall;
      EXPECT_NEAR(shear[i], 0, 1e-12) << "x = " << o.x[i] << ", wall " << wall;
      ++pressed;
    }
  EXPECT_EQ(pressed, 10) << "five nodes of either wall";
}

TEST(ContactProbes, a_node_that_touches_twice_has_its_length_once) {
  Scene scene = block_on_floor(0.004);
  // Two blocks over one another by less than a segment; the floor's node at x = 2 is under both.
  scene.grains[0].packing.positions = {{1.545, 0.246}, {2.455, 0.246}};
  const Model model = build_model(scene);
  Simulation simulation(model);
  Probe floor = probe_of("contact_length", "floor");
  floor.with = "all";
  EXPECT_NEAR(measured(simulation, floor)[0], 1.9, 1e-12) << "EXACT: 19 nodes";
  EXPECT_EQ(measured_vector(simulation, probe_of("contacts", "floor")), Vec2(2, 20)) << "EXACT: one of them twice";
}

TEST(ContactProbes, sliding_block_holds_its_elastic_slip) {
  Scene scene = block_on_floor(0.004);
  scene.grains[0].velocity = moving({0.1, 0});
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 1e-3);
  // EXACT: nodes still stick, so each carries its way along the floor; tau = -kt s. The block tips: nodes move apiece.
  const Points& points = model.outlines[model.bodies[0].outline].points;
  for (int k = 0; k < static_cast<int>(points.size()); ++k) {
    const auto at_k = [&](const char* quantity) {
      return measured(simulation, at_node(k, probe_of(quantity, "block")))[0];
    };
    if (points[k].y() > -0.249) continue;
    const double moved = at_k("displacement");
    EXPECT_GT(moved, 9e-5);
    EXPECT_NEAR(std::abs(at_k("contact_slip")), moved, 1e-10);
    EXPECT_NEAR(at_k("contact_shear"), -100 * at_k("contact_slip"), 1e-12);
    EXPECT_GT(at_k("contact_shear"), 0) << "EXACT: to the left of the floor's upward normal, against the motion";
  }
}

/// Rigid discs of diameter 1 in touching hexagonal order, periodic in x, `pitch` apart.
Scene hexagonal_discs(double pitch, int columns, int rows, int sides) {
  Scene scene = empty_scene(1);
  const double column = pitch * std::sqrt(3) / 2;
  scene.period = columns * column;
  scene.shapes = {polygonal_disc("disc", 1, sides)};
  Grains layer = grains("layer", "disc", BodyKind::rigid, {});
  layer.packing = {PackingKind::hexagonal, columns, rows, column, pitch, {0.1, 0}, {}};
  scene.grains = {layer};
  return scene;
}

TEST(PackingProbes, coordination_without_contacts_has_no_mean_of_those_held) {
  const Model model = build_model(hexagonal_discs(1.5, 2, 2, 48));
  Simulation simulation(model);
  const std::vector<double> coordination = measured(simulation, probe_of("coordination", "all"));
  EXPECT_EQ(coordination[0], 0) << "EXACT";
  EXPECT_TRUE(std::isnan(coordination[1])) << "EXACT";
  EXPECT_EQ(coordination[2], 1) << "EXACT: all rattle";
}

TEST(PackingProbes, coordination_of_a_hexagonal_packing) {
  const Model model = build_model(hexagonal_discs(0.98, 6, 5, 96));
  Simulation simulation(model);
  // INDEPENDENT: centres at most a pitch and a bit apart, in the next period too.
  std::vector<int> neighbours(model.bodies.size(), 0);
  for (std::size_t a = 0; a < model.bodies.size(); ++a)
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      Vec2 r = model.bodies[b].centre - model.bodies[a].centre;
      r.x() -= *model.scene.period * std::round(r.x() / *model.scene.period);
      if (a != b && r.norm() < 0.99) ++neighbours[a];
    }
  double mean = 0;
  for (std::size_t b = 0; b < neighbours.size(); ++b) {
    const std::vector<double> own = measured(simulation, probe_of("coordination", "layer " + std::to_string(b)));
    EXPECT_EQ(own[0], neighbours[b]) << "INDEPENDENT: grain " << b;
    mean += neighbours[b] / static_cast<double>(neighbours.size());
  }
  EXPECT_NEAR(measured(simulation, probe_of("coordination", "all"))[0], mean, 1e-14) << "INDEPENDENT";
  const auto six = static_cast<int>(std::find(neighbours.begin(), neighbours.end(), 6) - neighbours.begin());
  ASSERT_LT(six, static_cast<int>(neighbours.size())) << "EXACT: inner grains have six neighbours";
  const std::vector<double> fabric = measured(simulation, probe_of("fabric", "layer " + std::to_string(six)));
  EXPECT_NEAR(fabric[0], 0.5, 1e-3) << "EXACT but for the polygon of 96 sides: six directions are isotropic";
  EXPECT_NEAR(fabric[1], 0, 1e-3);
  EXPECT_NEAR(fabric[3], 0, 2e-3);
}

TEST(PackingProbes, fabric_finds_the_direction) {
  Scene scene = empty_scene(1);
  scene.shapes = {polygonal_disc("disc", 1, 360)};
  const double direction = -0.4;
  scene.grains = {
      grains("pair", "disc", BodyKind::rigid, {{0, 0}, {0.996 * std::cos(direction), 0.996 * std::sin(direction)}})};
  const Model model = build_model(scene);
  Simulation simulation(model);
  const std::vector<double> fabric = measured(simulation, probe_of("fabric", "all"));
  EXPECT_NEAR(fabric[0] + fabric[2], 1, 1e-14) << "EXACT: unit normals";
  EXPECT_NEAR(fabric[3], 1, 1e-14) << "EXACT: one contact";
  EXPECT_NEAR(fabric[4], direction, 2 * std::numbers::pi / 360) << "EXACT to a side";
}

TEST(PackingProbes, solid_fraction_of_a_hexagonal_packing) {
  const Model model = build_model(hexagonal_discs(1, 4, 6, 60));
  Simulation simulation(model);
  Probe probe = probe_of("solid_fraction", "all");
  const double exact = std::numbers::pi / (2 * std::sqrt(3));
  const double column = std::sqrt(3) / 2;
  // EXACT: boxes of whole cells, wherever they begin; across the period, and longer than it. Polygons have their discs'
  // area.
  for (const Vec2& low : {Vec2(0.05, 1.1), Vec2(1.3, 0.73), Vec2(3.1, 1.9), Vec2(-7.2, 1.4)})
    for (int cells : {1, 2, 4}) {
      probe.box = ProbeBox{low, low + Vec2(2 * cells * column, 2)};
      EXPECT_NEAR(measured(simulation, probe)[0], exact, 1e-12) << low.transpose() << ", " << cells;
    }
  probe.box = ProbeBox{{0, -20}, {1, -19}};
  EXPECT_EQ(measured(simulation, probe)[0], 0) << "EXACT: empty";
  probe.box = ProbeBox{{0.05, 1.95}, {0.15, 2.05}};
  EXPECT_NEAR(measured(simulation, probe)[0], 1, 1e-12) << "EXACT: inside the third grain of the first column";
}

TEST(PackingProbes, solid_fraction_between_walls) {
  const Scene scene = small_third_body(0.2);
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 0.2);
  Probe probe = probe_of("solid_fraction", "all");
  probe.between = {"upper", "lower"};
  const double top = measured_vector(simulation, probe_of("position", "upper")).y();
  const double area = measured(simulation, probe_of("area", "all"))[0];
  EXPECT_NEAR(measured(simulation, probe)[0], area / (6 * (top + 1.02)), 1e-12) << "EXACT: flat walls";
}

}  // namespace
}  // namespace pliant::dynamics_tests
