// A body that touches its own periodic image does as two bodies in twice the period, which touch each other.
#include <gtest/gtest.h>

#include <limits>

#include "core/errors.hpp"
#include "setup/build_model.hpp"
#include "support/contact_rig.hpp"
#include "support/probing.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double pitch = 1.13;

Points row_of(int copies, const Vec2& first, double distance) {
  Points centres;
  for (int i = 0; i < copies; ++i) centres.emplace_back(first + Vec2(i * distance, 0));
  return centres;
}

/// Leaning ellipses, each wider than the period, side by side and just apart. Turning flatter they hit and rub.
Scene ellipses(BodyKind kind, int copies, const ContactRule& contact) {
  Scene scene = empty_scene(1);
  ShapeSpec ellipse = disc_shape("ellipse", 0, 90);
  ellipse.kind = ShapeKind::curve;
  for (const Vec2& p : testing::regular(720, 1)) ellipse.points.emplace_back(p.x(), 0.4 * p.y());
  scene.shapes = {ellipse};
  scene.period = copies * pitch;
  scene.grains = {grains("row", "ellipse", kind, row_of(copies, {0.31, 0.2}, pitch), moving({0.2, 0.1}, -0.5))};
  scene.grains[0].angle = 40 * M_PI / 180;
  scene.contacts = {contact};
  scene.time.safety = 0.4;
  return scene;
}

/// Blocks that two plates squeeze until their sides meet; the plates' nodes under a block are as many as a period has,
/// and more.
Scene squeezed_blocks(int copies) {
  Scene scene = empty_scene(10);
  constexpr double period = 1.05;
  scene.period = copies * period;
  scene.materials[0].mass_damping = 0.5;
  scene.shapes = {box_shape("block", 0.9, 0.5, 0.1)};
  scene.grains = {grains("row", "block", BodyKind::compliant, row_of(copies, {0.5, 0.25}, period))};
  scene.walls = {flat_wall("floor", Wall::Solid::below, 0, period / 10),
                 flat_wall("top", Wall::Solid::above, 0.5, period / 10)};
  scene.walls[1].y = {AxisCondition::Mode::velocity, {{0, 20}, {-0.02, -0.02}}};
  scene.contacts = {mohr_coulomb(200, 0.2)};
  return scene;
}

ContactRule sticky() {
  ContactRule rule = contact_rule(ContactLawKind::cohesive, 100);
  rule.strength = 0.3;
  rule.range = 0.02;
  return rule;
}

struct ImageContact {
  int contacts = 0;
  double stored = 0, dissipated = 0, momentum = 0;
};

/// Steps both to the end. Each step rounds positions of up to 4 by 2^-52 of that at most, and the bound of a step by
/// what finite differences over 1e-6 of the nodal distance make of such a rounding, 1e-9, which moves the error of the
/// integration, less than 1e-3, by 1e-12.
ImageContact run_both(const Scene& single, const Scene& twice) {
  const Model one = build_model(single), two = build_model(twice);
  Simulation a(one), b(two);
  ImageContact seen;
  while (a.state().time < single.time.end) {
    seen.contacts = std::max(seen.contacts, a.step(single.time.end).evaluation.contact.contacts);
    if (a.state().steps % 20 != 0) continue;
    const EnergyBalance audit = a.energy_balance();
    seen.stored = std::max(seen.stored, std::abs(audit.energy.contact));
    seen.momentum = std::max(seen.momentum, audit.momentum_error);
  }
  advance(b, single.time.end);
  seen.dissipated = a.state().dissipated;
  EXPECT_EQ(a.state().steps, b.state().steps) << "EXACT";
  EXPECT_EQ(a.state().rejections, b.state().rejections) << "EXACT";
  const double tolerance = static_cast<double>(a.state().steps) * 4 * std::numeric_limits<double>::epsilon() + 1e-12;
  double difference = 0;
  const OutlineField &x = a.state().outlines.position, &y = b.state().outlines.position;
  for (int copy = 0; copy < 2; ++copy)
    for (int k = 0; k < one.outlines[one.bodies[0].outline].count; ++k) {
      const int i = k, j = b.model().outline_offset[copy] + k;
      difference = std::max({difference, std::abs(x.x[i] + copy * *single.period - y.x[j]), std::abs(x.y[i] - y.y[j])});
    }
  EXPECT_LT(difference, tolerance) << "EXACT: rounding";
  EXPECT_NEAR(2 * a.state().dissipated, b.state().dissipated, 100 * tolerance) << "EXACT: two bodies; stiffness 100";
  ::testing::Test::RecordProperty("difference", std::to_string(difference / tolerance));
  return seen;
}

class OwnImage : public ::testing::TestWithParam<BodyKind> {};

TEST_P(OwnImage, is_another_body_in_twice_the_period) {
  for (const ContactRule& rule : {frictionless(100), mohr_coulomb(100, 0.4), sticky()}) {
    SCOPED_TRACE(static_cast<int>(rule.law));
    const ImageContact seen = run_both(ellipses(GetParam(), 1, rule), ellipses(GetParam(), 2, rule));
    EXPECT_GT(seen.contacts, 3) << "it must touch, or this test says nothing";
    EXPECT_GT(seen.stored, 1e-4);
    EXPECT_EQ(seen.dissipated > 1e-6, rule.law != ContactLawKind::frictionless);
    EXPECT_LT(seen.momentum, 1e-12) << "EXACT: what it does to its image the image does to it";
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, OwnImage, ::testing::Values(BodyKind::compliant, BodyKind::rigid));

TEST(OwnImages, meet_between_plates) {
  const ImageContact seen = run_both(squeezed_blocks(1), squeezed_blocks(2));
  EXPECT_GT(seen.contacts, 30);
  const auto force = [](int copies) {
    const Scene scene = squeezed_blocks(copies);
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, scene.time.end);
    return contact_force(simulation, copies + 1).y();
  };
  const double one = force(1);
  EXPECT_NEAR(2 * one, force(2), 1e-9 * one) << "EXACT: plates of twice the length; 1e-12 on gaps at stiffness 200";
}

// EXACT: where soft corners, those of the images and the plates' nodes come together, each node's face and length
// change without a jump; allowed is a tenth of what a run warns of, at any step. Faces that change at once made 3.4 %.
TEST(OwnImages, soft_corners_pressed_deep_make_no_energy) {
  const auto balance = [](double safety) {
    Scene scene = squeezed_blocks(1);
    scene.contacts = {frictionless(235)};
    scene.walls[1].y = {AxisCondition::Mode::velocity, {{0, 20, 20.001}, {-0.01, -0.01, 0}}};
    scene.time.end = 30;
    scene.time.safety = safety;
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, scene.time.end);
    return simulation.balance_error(simulation.energy_balance().energy);
  };
  EXPECT_LT(balance(0.8), 1e-3);
  EXPECT_LT(balance(0.2), 1e-3);
}

/// EXACT: forces from its own image cannot move a rigid body, only turn it.
TEST(OwnImages, do_not_push) {
  const Model model = build_model(ellipses(BodyKind::rigid, 1, mohr_coulomb(100, 0.4)));
  Simulation simulation(model);
  advance(simulation, 1);
  const Eigen::Vector3d velocity = rigid(simulation.state().reduced_momentum, 0);
  EXPECT_NEAR(velocity.x(), 0.2, 1e-13);
  EXPECT_NEAR(velocity.y(), 0.1, 1e-13);
  EXPECT_GT(velocity.z(), -0.4) << "it came to rub";
}

TEST(OwnImages, count_as_in_twice_the_period) {
  const auto look = [](int copies, const char* quantity) {
    const Model model = build_model(ellipses(BodyKind::rigid, copies, sticky()));
    Simulation simulation(model);
    advance(simulation, 0.3);
    return measured(simulation, probe_of(quantity, "row"));
  };
  const std::vector<double> one = look(1, "contacts"), two = look(2, "contacts");
  EXPECT_EQ(one[0], 1) << "EXACT: a pair in each period";
  EXPECT_EQ(two[0], 2) << "EXACT";
  EXPECT_GT(one[1], 0);
  EXPECT_EQ(2 * one[1], two[1]) << "EXACT: nodes";
  EXPECT_EQ(look(1, "coordination")[0], 2) << "EXACT: its image on either side";
  EXPECT_EQ(look(2, "coordination")[0], 2) << "EXACT";
  const std::vector<double> fabric = look(1, "fabric"), twice = look(2, "fabric");
  EXPECT_GT(fabric[0], 0.1);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(fabric[i], twice[i], 1e-9) << "EXACT: the mean over alike pairs";
}

/// EXACT: self-contact looks at one outline, images at two: neither takes the other's contact pairs for its own.
TEST(OwnImages, are_no_self_contact) {
  const auto end = [](bool self_contact) {
    Scene scene = ellipses(BodyKind::compliant, 1, mohr_coulomb(100, 0.4));
    scene.contact.self_contact = self_contact;
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 1);
    return simulation.state().position.compliant[5][0];
  };
  EXPECT_EQ(end(true), end(false));
}

/// EXACT: as between any two bodies.
TEST(OwnImages, are_not_to_overlap_at_the_start) {
  Scene scene = ellipses(BodyKind::rigid, 1, frictionless(100));
  scene.period = 0.9;
  const Model model = build_model(scene);
  try {
    const Simulation simulation(model);
    FAIL() << "an overlap of two segments";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("its own periodic image"), std::string::npos) << error.what();
  }
}

/// Contact may come before the next refresh: its bound is there from the start, 2/w about 2/sqrt(100 x 4.6 m / 1.25
/// kg/m) = 0.1 s.
TEST(OwnImages, bound_the_step_of_a_lone_body) {
  Scene scene = ellipses(BodyKind::rigid, 1, frictionless(100));
  scene.grains[0].velocity = moving({0, 0}, -1e-6);
  const Model model = build_model(scene);
  Simulation simulation(model);
  EXPECT_LT(simulation.largest_dt(), 0.1);
}

}  // namespace
}  // namespace pliant::dynamics_tests
