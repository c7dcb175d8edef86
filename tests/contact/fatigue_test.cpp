// Bonds with damage: the energy balance against the work of the tractions, and what a run starts with.
#include <gtest/gtest.h>

#include <cmath>

#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr double kn = 100, strength = 0.5, range = 0.03, ratio = 1.25;

ContactRule bond_rule() { return cohesive_fatigue(kn, strength, range, ratio, 0.001); }

// A block on a longer bar, face to face; no node of the bar lies within the range beside the block's corners.
Scene block_on_bar(const ContactRule& rule, double gap = 0) {
  Scene scene = bare_scene();
  scene.contacts = {rule};
  add_body(scene, outline_shape("bar", rectangle(3, 0.5, 0.1)), BodyKind::rigid, {0, 0});
  add_body(scene, outline_shape("block", rectangle(1.1, 0.5, 0.11)), BodyKind::rigid, {0, 0.5 + gap});
  return scene;
}

// Moves the block along a path and energy balance what moving it takes.
class Path {
 public:
  explicit Path(const ContactRule& rule) : rig(block_on_bar(rule)) {
    rig.step();
    start_ = rig.totals.stored;
  }
  void go(const Vec2& by, int steps) {
    for (int i = 0; i < steps; ++i) {
      const Vec2 before = rig.force(1);
      rig.move(1, by / steps);
      rig.step();
      work -= 0.5 * (before + rig.force(1)).dot(by / steps);
    }
  }
  double imbalance() const { return work - (rig.totals.stored - start_) - rig.dissipated; }

  ContactRig rig;
  double work = 0;

 private:
  double start_ = 0;
};

double lost(Path& path) { return path.rig.dissipated; }

// EXACT: opening and shear, apart and together, with damage on the way, closed again: tractions are straight in each
// step between damage and damage, so that their work is stored or dissipated to rounding, whatever the steps.
TEST(Fatigue, WorkIsStoredOrDissipated) {
  for (const int steps : {1, 3, 40}) {
    Path path(bond_rule());
    for (const Vec2& by : {Vec2(0, 0.012), Vec2(0.01, 0), Vec2(-0.02, -0.004), Vec2(0.01, -0.008)}) path.go(by, steps);
    EXPECT_NEAR(path.imbalance(), 0, 1e-14) << steps;
    EXPECT_GT(lost(path), 5e-4) << "or this test says nothing";
    EXPECT_NEAR(path.rig.totals.stored, 0, 1e-14) << "the path is closed";
  }
}

// EXACT: below the critical opening nothing is lost; along the same way back neither, with damage or without.
TEST(Fatigue, UnloadingIsElastic) {
  Path path(bond_rule());
  path.go({0.003, 0.003}, 7);
  path.go({-0.003, -0.003}, 3);
  EXPECT_NEAR(lost(path), 0, 1e-16);
  path.go({0.01, 0.01}, 5);
  const double before = lost(path), stored = path.rig.totals.stored;
  path.go({-0.01, -0.01}, 1);
  path.go({0.01, 0.01}, 4);
  EXPECT_NEAR(lost(path), before, 1e-16);
  EXPECT_NEAR(path.rig.totals.stored, stored, 1e-14);
  EXPECT_GT(before, 1e-4);
}

/// Of bonds, half of it in either pass: 11 nodes of the block at 0.11, of which those at the corners stand for half of
/// a segment of 0.1 of the side, and 11 of the bar at 0.1.
constexpr double length = 0.5 * (9 * 0.11 + 2 * 0.105 + 11 * 0.1);

int bonded_nodes(const ContactRig& rig) {
  int nodes = 0;
  for (const ContactPair& contact_pair : rig.contact.contact_pairs())
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < contact_pair.nodes[side].count; ++i)
        nodes += rig.committed.number(contact_pair.record[side] + i, ContactHistory::first_of_law) < 1;
  return nodes;
}

// EXACT: tearing costs strength x range / 2 a unit of length, in shear the same, in steps that end at the corners of
// the law. On the way the traction falls in a straight line, and steps that are straight lose nothing.
TEST(Fatigue, TearingTakesTheFractureEnergy) {
  const double critical = strength / kn;
  for (const bool shear : {false, true}) {
    Path path(bond_rule());
    EXPECT_EQ(bonded_nodes(path.rig), 11 + 11);
    const Vec2 way = shear ? Vec2(ratio, 0) : Vec2(0, 1);
    path.go(critical * way, 1);
    EXPECT_NEAR(std::abs(path.rig.force(1).dot(way)) / length, strength, 1e-12);
    path.go((range - critical) / 2 * way, 3);
    EXPECT_NEAR(std::abs(path.rig.force(1).dot(way)) / length, strength / 2, 1e-12);
    path.go((1 + 1e-9) * (range - critical) / 2 * way, 2);
    EXPECT_EQ(bonded_nodes(path.rig), 0);
    EXPECT_NEAR(lost(path) / (length * strength * range / 2), 1, 1e-8)
        << "a little further, so that rounding decides nothing";
    EXPECT_EQ(path.rig.force(1).norm(), 0);
  }
}

// EXACT: a torn contact presses with kn, and pulls and slips like the cohesive law of the residual strength, and
// friction.
TEST(Fatigue, LeavesTheResidualLaw) {
  ContactRule rule = bond_rule();
  rule.residual_strength = 0.2, rule.friction = 0.3;
  Path path(rule);
  path.go({0, 0.04}, 8);
  EXPECT_NEAR(path.imbalance(), 0, 1e-4) << "RATE: steps across the corners of the residual law";
  path.go({0, -0.038}, 8);
  EXPECT_NEAR(path.rig.force(1).y() / length, -0.2, 1e-12) << "at its strength";
  path.go({0, -0.007}, 8);
  path.go({0.02, 0}, 50);
  EXPECT_NEAR(path.rig.force(1).y() / length, kn * 0.005, 1e-12);
  EXPECT_NEAR(path.rig.force(1).x() / length, -(0.2 / ratio + 0.3 * kn * 0.005), 1e-12);
}

// EXACT: friction acts beside a bond in the share that is broken, with one stiffness: pressed, sheared past the
// strength, the traction is (1 - D) kt s + D min(kt s, friction p), until it tears and on; stored or dissipated.
TEST(Fatigue, FrictionActsInTheBrokenShare) {
  ContactRule rule = bond_rule();
  rule.friction = 0.4;
  const double kt = kn / (ratio * ratio), depth = 0.01, most = rule.friction * kn * depth, critical = strength / kn;
  Path path(rule);
  path.go({0, -depth}, 5);
  double slip = 0;
  for (int i = 0; i < 26; ++i) {  // further on a node of the bar meets the block's flank
    path.go({0.0015, 0}, 1);
    slip += 0.0015;
    const double delta = slip / ratio,
                 damage = std::clamp(range * (delta - critical) / (delta * (range - critical)), 0.0, 1.0);
    const double expected = (1 - damage) * kt * slip + damage * std::min(kt * slip, most);
    EXPECT_NEAR(-path.rig.force(1).x() / length, expected, 1e-12) << slip;
    EXPECT_NEAR(-path.rig.force(1).y() / length, -kn * depth, 1e-12);
  }
  EXPECT_EQ(bonded_nodes(path.rig), 0);
  EXPECT_NEAR(path.imbalance(), 0, 1e-14);
}

// EXACT: a bond weaker than friction changes nothing of what friction bears while slip grows: nowhere less than
// min(kt s, friction p), and just kt s until both give way. Back and forth, with the pressure changing, the energy
// balance stay whole.
TEST(Fatigue, AWeakBondWeakensNothing) {
  ContactRule rule = cohesive_fatigue(kn, 0.02, range, ratio, 0.001);
  rule.friction = 0.5;
  const double kt = kn / (ratio * ratio), depth = 0.01, most = rule.friction * kn * depth;
  Path path(rule);
  path.go({0, -depth}, 1);
  for (double slip = 0.0005; slip < 0.02; slip += 0.0005) {
    path.go({0.0005, 0}, 1);
    const double borne = -path.rig.force(1).x() / length;
    EXPECT_GE(borne, std::min(kt * slip, most) - 1e-12) << slip;
    if (kt * slip < most) {
      EXPECT_NEAR(borne, kt * slip, 1e-12) << slip;
    }
  }
  EXPECT_GT(bonded_nodes(path.rig), 0) << "or this test says nothing of bonds";
  for (const Vec2& by : {Vec2(-0.03, 0.004), Vec2(0.012, -0.006), Vec2(-0.004, 0.001), Vec2(0.03, 0.003)})
    path.go(by, 20);
  EXPECT_NEAR(path.imbalance(), 0, 1e-14);
}

// EXACT: nothing that a bond does gives energy back that was dissipated. Slid under little pressure, pressed, and slid
// back, friction comes to store more than the bond, which wears on: more damage would then take energy. Less than kt s
// ds of a unit of damage in a step: tractions there are means.
TEST(Fatigue, DissipationNeverFalls) {
  ContactRule rule = bond_rule();
  rule.friction = 0.5, rule.fatigue_rate = rule.shear_fatigue_rate = 2;
  Path path(rule);
  constexpr double step = 1e-5, reach = 0.016;
  const double tolerance = length * kn / (ratio * ratio) * reach * step;
  double most = 0;
  for (const Vec2& by : {Vec2(0, -0.002), Vec2(0.008, 0), Vec2(0, -0.02), Vec2(-0.016, 0), Vec2(0.012, 0.015)}) {
    const int steps = static_cast<int>(by.norm() / step);
    for (int i = 0; i < steps; ++i) {
      path.go(by / steps, 1);
      most = std::max(most, lost(path));
      ASSERT_GE(lost(path), most - tolerance) << path.work;
    }
  }
  EXPECT_GT(most, 20 * tolerance);
  EXPECT_NEAR(path.imbalance(), 0, 1e-12);
}

// INDEPENDENT: dD = rate (p - threshold) / (strength - threshold) dp along p = (1 - D) kn g, in a million small steps.
// The engine's are fewer, and their
// damage counts from the next one on: RATE, half of the damage of a step.
TEST(Fatigue, EachLoadAddsItsDamage) {
  ContactRule rule = bond_rule();
  rule.fatigue_threshold = 0.1, rule.fatigue_rate = 0.5;
  Path path(rule);
  const double opening = 0.4 / kn;
  const auto damage = [&] { return 1 - path.rig.totals.stored * 2 / (kn * opening * opening * length); };
  double expected = 0;
  const auto load = [&] {
    constexpr int steps = 1'000'000;
    for (int i = 0; i < steps; ++i) {
      const double p = (1 - expected) * kn * opening * (i + 0.5) / steps;
      expected += 0.5 * std::max(p - 0.1, 0.0) / 0.4 * (1 - expected) * kn * opening / steps;
    }
  };
  for (int loads = 0; loads < 4; ++loads) {
    path.go({0, opening}, 400);
    load();
    EXPECT_NEAR(damage(), expected, 0.06 / 400 * (loads + 1)) << "load " << loads;
    path.go({0, -opening}, 3);
  }
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(path.imbalance(), 0, 1e-13) << "EXACT: rounding of 1600 steps";
}

// EXACT: bonds are there where the gap is small at the start, and nowhere else; what meets later finds none. A refresh
// keeps them.
TEST(Fatigue, BondsAreThereFromTheStart) {
  Scene scene = block_on_bar(bond_rule(), 0.0005);
  add_body(scene, outline_shape("far", rectangle(0.5, 0.3, 0.1)), BodyKind::rigid, {1.2, 0.402});
  ContactRig rig(scene);
  rig.step();
  const auto damaged = [&](int body) {
    const std::vector<double> damage = rig.contact.least_internal_variable(rig.committed, "damage", 1);
    double least = 1;
    for (int k = 0; k < rig.count(body); ++k) least = std::min(least, damage[rig.model.outline_offset[body] + k]);
    return least;
  };
  EXPECT_EQ(damaged(0), 0);
  EXPECT_EQ(damaged(1), 0);
  EXPECT_EQ(damaged(2), 1);
  rig.move(1, {0, 0.0145});
  rig.move(2, {0, -0.003});
  rig.step();
  const double stretched = damaged(1);
  EXPECT_NEAR(stretched, 0.03 * (0.015 - 0.005) / (0.015 * 0.025), 1e-12);
  EXPECT_EQ(damaged(2), 1);
  EXPECT_GT(rig.force(2).y(), 0) << "pressed";
  const Vec2 force = rig.force(1);
  rig.refresh();
  rig.step();
  EXPECT_EQ(damaged(1), stretched);
  EXPECT_EQ(rig.force(1), force);
  rig.move(2, {0, 0.003});
  rig.step();
  EXPECT_EQ(rig.force(2).norm(), 0) << "no bond, no pull";
  rig.move(1, {0, 1});
  rig.step();
  EXPECT_EQ(damaged(1), 1);
}

// EXACT: bodies that are out of each other's sight at the start, so that no node has a record, find no bond when
// they meet.
TEST(Fatigue, BodiesFromAfarHaveNoBonds) {
  ContactRig rig(block_on_bar(bond_rule(), 2));
  rig.step();
  for (const ContactPair& contact_pair : rig.contact.contact_pairs()) ASSERT_TRUE(contact_pair.is_empty());
  rig.move(1, {0, -2 + 0.0005});
  rig.step();
  ASSERT_EQ(rig.committed.fields(), 3);
  EXPECT_EQ(bonded_nodes(rig), 0);
  rig.move(1, {0, 0.005});
  rig.step();
  EXPECT_EQ(rig.force(1).norm(), 0) << "no bond, no pull";
}

// EXACT: scenes without the law keep no damage.
TEST(Fatigue, OtherLawsKeepNoDamage) {
  ContactRig rig(block_on_bar(cohesive(kn, strength, range, strength)));
  rig.step();
  EXPECT_EQ(rig.committed.fields(), 0);
}

}  // namespace
}  // namespace pliant
