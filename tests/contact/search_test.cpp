#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "support/contact_oracle.hpp"

namespace pliant {
namespace {

using namespace testing;

// Coordinates of size L carry errors of eps L, so gaps do; a node adds up a few records of stiffness times length 1.
// 1e-16 x 10 x 100 x some ten records and reactions: 1e-12, of forces of order 1.
constexpr double force_rounding = 2e-12;

std::pair<double, double> segment_lengths(const ContactRig& rig) {
  std::pair<double, double> result{1e300, 0};
  for (int body = 0; body < static_cast<int>(rig.model.bodies.size()); ++body)
    for (int k = 0; k < rig.count(body); ++k) {
      if (rig.model.bodies[body].wall && k + 1 == rig.count(body)) break;  // the last one leads to the next period
      const double length = (rig.node(body, (k + 1) % rig.count(body)) - rig.node(body, k)).norm();
      result = {std::min(result.first, length), std::max(result.second, length)};
    }
  return result;
}

void expect_equal(const ContactRig& rig, const ContactOracle::Result& expected) {
  EXPECT_EQ(rig.totals.contacts, expected.contacts);
  for (std::size_t b = 0; b < rig.model.bodies.size(); ++b)
    for (int k = 0; k < rig.count(static_cast<int>(b)); ++k)
      EXPECT_LT((rig.force(static_cast<int>(b), k) - expected.force[b][k]).norm(), force_rounding)
          << "body " << b << ", node " << k;
  EXPECT_NEAR(rig.totals.stored, expected.stored, force_rounding);
  EXPECT_NEAR(rig.totals.dissipated, expected.dissipated, force_rounding);
  // The engine's measure is the longest segment near the contact.
  const auto [shortest, longest] = segment_lengths(rig);
  EXPECT_LE(rig.totals.deepest, expected.deepest / shortest + force_rounding);
  EXPECT_GE(rig.totals.deepest, expected.deepest / longest - force_rounding);
}

const ContactRule search_rules[] = {frictionless(kn), mohr_coulomb(kn, 0.3, 0.05, 0.2), cohesive(kn, 0.5, 0.02, 0.4),
                                    smoothed(frictionless(kn), 0.05), smoothed(mohr_coulomb(kn, 0.3, 0.05), 0.1)};
constexpr int rule_count = 5;

// Two bodies of given kinds pressed into each other; false when a node lies too deep for the contact box.
bool compare_pair(Random& random, const ContactRule& rule, int kind_a, int kind_b) {
  Scene scene = nodal_scene();
  scene.contacts = {rule};
  for (const int kind : {kind_a, kind_b}) add_random_body(scene, random, kind);
  ContactRig rig(scene);
  press_together(rig, random, random.uniform(-0.02, 0.06));
  rig.evaluate();
  const ContactOracle::Result expected = ContactOracle(rig, rule).evaluate();
  if (expected.outside_truth > 0) return false;
  expect_equal(rig, expected);
  return true;
}

// INDEPENDENT: the brute force of contact_oracle.hpp; every pair of five kinds of outline, five laws.
TEST(ContactSearch, EqualsBruteForceOnRandomOutlines) {
  int compared = 0, samples = 0;
  for (int kind_a = 0; kind_a < 5; ++kind_a)
    for (int kind_b = 0; kind_b < 5; ++kind_b)
      for (int rule = 0; rule < rule_count; ++rule)
        for (int sample = 0; sample < 5; ++sample, ++samples) {
          SCOPED_TRACE("kinds " + std::to_string(kind_a) + " " + std::to_string(kind_b) + ", rule " +
                       std::to_string(rule) + ", sample " + std::to_string(sample));
          Random random(1000 * samples + 7);
          compared += compare_pair(random, search_rules[rule], kind_a, kind_b);
          if (::testing::Test::HasFailure()) return;
        }
  EXPECT_GT(compared, samples / 2);
}

// A heap: five rigid and three compliant bodies in a narrow period between two walls, squeezed towards each other.
Scene heap(Random& random, const ContactRule& rule, bool asperities) {
  Scene scene = nodal_scene();
  scene.period = 4;
  scene.contacts = {rule};
  for (int i = 0; i < 8; ++i) {
    const Vec2 centre(random.uniform(-9, 9), 0.98 + 1.96 * (i / 2));
    const Vec2 beside(i % 2 == 0 ? 0 : scene.grains.back().packing.positions[0].x() + 1.98 - centre.x(), 0);
    const bool compliant = i % 3 == 1;
    add_body(scene, polygonal_disc("disc", 2, 30, compliant ? std::optional<int>(60) : std::nullopt),
             compliant ? BodyKind::compliant : BodyKind::rigid, centre + beside, random.uniform(0, 6));
  }
  scene.walls = {flat_wall("floor", Wall::Solid::below, asperities ? -0.46 : 0.0, 0.15),
                 flat_wall("lid", Wall::Solid::above, 7.83, 0.15)};
  if (asperities) scene.walls[0].asperities = Asperities{0.9, 4, 0.2, {0, 0.05}, {0.8, 0.5}};
  return scene;
}

// INDEPENDENT: walls with and without asperities, discs across the period and several periods away, both kinds of body.
TEST(ContactSearch, EqualsBruteForceInAPeriodicHeap) {
  for (int sample = 0; sample < 12; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 50);
    const ContactRule& rule = search_rules[sample % rule_count];
    ContactRig rig(heap(random, rule, sample % 2 == 0));
    rig.evaluate();
    const ContactOracle::Result expected = ContactOracle(rig, rule).evaluate();
    EXPECT_EQ(expected.outside_truth, 0);
    EXPECT_GT(expected.contacts, 20);
    expect_equal(rig, expected);
  }
}

// Shares a relative motion of just under the skin between two bodies.
void move_by_the_skin(ContactRig& rig, Random& random) {
  const double angle = random.uniform(0, 2 * M_PI), share = random.uniform(-1, 2);
  const Vec2 motion = 0.999 * rig.contact.skin() * Vec2(std::cos(angle), std::sin(angle));
  rig.move(0, share * motion);
  rig.move(1, (share - 1) * motion);
}

// INDEPENDENT: candidates found before a motion of the whole skin still hold all contacts after it.
TEST(ContactSearch, MissesNoContactWithinTheSkin) {
  int compared = 0, samples = 0;
  for (int kind_a = 0; kind_a < 5; ++kind_a)
    for (int kind_b = 0; kind_b < 5; ++kind_b)
      for (int sample = 0; sample < 12; ++sample, ++samples) {
        SCOPED_TRACE("kinds " + std::to_string(kind_a) + " " + std::to_string(kind_b) + ", sample " +
                     std::to_string(sample));
        Random random(1000 * samples + 3);
        Scene scene = nodal_scene();
        const ContactRule& rule = search_rules[sample % rule_count];
        scene.contacts = {rule};
        for (const int kind : {kind_a, kind_b}) add_random_body(scene, random, kind);
        ContactRig rig(scene);
        press_together(rig, random, random.uniform(-0.05, 0.05));
        rig.refresh();
        ContactOracle oracle(rig, rule);
        oracle.evaluate();  // a refresh notes where nodes are, so that slip counts from there
        oracle.commit();
        move_by_the_skin(rig, random);
        if (rig.evaluate()) continue;
        const ContactOracle::Result expected = oracle.evaluate();
        if (expected.outside_truth > 0) continue;
        ++compared;
        expect_equal(rig, expected);
        if (::testing::Test::HasFailure()) return;
      }
  EXPECT_GT(compared, samples / 2);
}

// Every body on its own way and turning, until the system itself asks for a refresh; then again.
void follow_heap(const ContactRule& rule) {
  Random random(77);
  ContactRig rig(heap(random, rule, true));
  ContactOracle oracle(rig, rule);
  int refreshes = 0;
  for (int step = 0; step < 40; ++step) {
    for (std::size_t b = 0; b + 2 < rig.model.bodies.size(); ++b) {
      rig.move(static_cast<int>(b), {random.uniform(-0.003, 0.003), random.uniform(-0.003, 0.003)});
      if (rig.model.bodies[b].kind == BodyKind::rigid) rig.turn(static_cast<int>(b), random.uniform(-0.005, 0.005));
    }
    rig.move(9, {0.01, 0});  // the lid shears
    refreshes += rig.evaluate();
    const ContactOracle::Result expected = oracle.evaluate();
    SCOPED_TRACE(step);
    EXPECT_EQ(expected.outside_truth, 0);
    expect_equal(rig, expected);
    if (::testing::Test::HasFailure()) return;
    rig.commit();
    oracle.commit();
  }
  EXPECT_GT(refreshes, 2);
  EXPECT_GT(rig.dissipated, 0.001);
}

TEST(ContactSearch, MissesNoContactInAMovingHeap) { follow_heap(search_rules[2]); }

// Two bodies fly at each other, turning, from beyond every margin until they overlap; each step is far below the skin.
void approach(Random& random, const ContactRule& rule) {
  Scene scene = nodal_scene();
  scene.contacts = {rule};
  for (int i = 0; i < 2; ++i) add_random_body(scene, random, random.below(5));
  ContactRig rig(scene);
  press_together(rig, random, 0.04);
  const Vec2 d = 0.15 * rig.contact.skin() * Vec2(rig.rigid(1)[0], rig.rigid(1)[1]).normalized();
  const double share = random.uniform(-1, 2), turn = 0.1 * rig.contact.skin() * random.uniform(-1, 1);
  const int steps = static_cast<int>(0.6 / d.norm());
  rig.move(1, steps * d);
  rig.turn(0, -steps * turn);
  ContactOracle oracle(rig, rule);
  for (int step = 0; step < steps; ++step) {
    rig.move(1, -share * d);
    rig.move(0, (1 - share) * d);
    rig.turn(0, turn);
    rig.evaluate();
    if (steps - step > 0.1 / d.norm()) continue;
    const ContactOracle::Result expected = oracle.evaluate();
    if (expected.outside_truth > 0) return;
    EXPECT_EQ(rig.totals.contacts, expected.contacts) << "step " << step;
  }
}

// INDEPENDENT: the first contact of bodies that were strangers before is found in its step.
TEST(ContactSearch, SeesBodiesComing) {
  for (int sample = 0; sample < 30; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 4000);
    approach(random, search_rules[sample % rule_count]);
  }
}

// EXACT: a refresh is asked for before two close bodies have moved by the skin against each other, whoever moves and
// turns.
TEST(ContactSearch, AsksForARefreshInTime) {
  const auto asks = [](double first, double second, double turn) {
    Scene scene = nodal_scene();
    scene.contacts = {search_rules[0]};
    for (int i = 0; i < 2; ++i) add_body(scene, polygonal_disc("disc", 2, 40), BodyKind::rigid, {2.01 * i, 0});
    ContactRig rig(scene);
    rig.refresh();
    const double skin = rig.contact.skin();
    rig.move(0, {0, first * skin});
    rig.move(1, {0, second * skin});
    rig.turn(1, turn * skin);  // at radius 1
    rig.show();
    return !rig.contact.candidates_hold(rig.outlines.position);
  };
  EXPECT_FALSE(asks(0, 0, 0));
  EXPECT_FALSE(asks(0.9, 0, 0));
  EXPECT_FALSE(asks(2, 2, 0));  // together
  EXPECT_TRUE(asks(1.01, 0, 0));
  EXPECT_TRUE(asks(0, -1.01, 0));
  EXPECT_TRUE(asks(0.51, -0.51, 0));
  EXPECT_TRUE(asks(0, 0, 1.01));
  EXPECT_TRUE(asks(0.3, 0.3 - 0.51, 0.51));
}

// EXACT: what stands on a bisector by symmetry falls to one segment, whatever rounding says of it: a node of a disc
// straight above one of a wall, near by or a thousand periods on.
TEST(ContactSearch, BreaksTiesTheSameWay) {
  const auto force_at = [](double x) {
    Scene scene = nodal_scene();
    scene.period = 4;
    scene.contacts = {search_rules[0]};
    add_body(scene, outline_shape("disc", regular(24, 1, -M_PI / 2)), BodyKind::rigid, {x, 0.98});
    scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 0.25 * (1 + 1e-9))};
    ContactRig rig(scene);
    rig.evaluate();
    return rig.force(0);
  };
  const Vec2 plain = force_at(1);
  EXPECT_GT(std::abs(plain.x()), 0.01 * plain.y()) << "of the one segment's normal";
  // Gaps of coordinates up to 4000 carry errors of 5e-13.
  for (const double x : {1 - 1e-12, 1 + 1e-12, 1.0 + 4, 1.0 - 4 * 7, 1.0 + 4 * 1000})
    EXPECT_LT((force_at(x) - plain).norm(), 1e-12 * kn * 20) << x;
}

// EXACT, bit by bit (docs/design.md 5): one thread or five.
TEST(ContactSearch, DoesNotDependOnThreads) {
  std::vector<std::vector<double>> forces;
  for (const int threads : {1, 5}) {
    const int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    Random random(50);
    ContactRig rig(heap(random, search_rules[2], true));
    rig.step();
    for (int body = 0; body < 8; ++body) rig.move(body, {0.003 * body, -0.002});
    rig.step();
    omp_set_num_threads(before);
    forces.push_back({rig.totals.stored, rig.dissipated});
    for (int body = 0; body < 10; ++body)
      for (int k = 0; k < rig.count(body); ++k) forces.back().push_back(rig.force(body, k).x());
  }
  EXPECT_TRUE(forces[0] == forces[1]);
}

// EXACT: bodies apart have no contacts, and none is left behind by a refresh.
TEST(ContactSearch, BodiesApartDoNotTouch) {
  Scene scene = nodal_scene();
  scene.contacts = {search_rules[2]};
  for (int i = 0; i < 3; ++i) add_body(scene, polygonal_disc("disc", 2, 40), BodyKind::rigid, {2.5 * i, 0});
  ContactRig rig(scene);
  rig.step();
  EXPECT_EQ(rig.totals.contacts, 0);
  rig.move(0, {0.49, 0});
  rig.step();
  EXPECT_GT(rig.totals.contacts, 0);
  rig.move(0, {-0.49, 0});
  rig.step();
  EXPECT_EQ(rig.totals.contacts, 0);
  EXPECT_EQ(rig.totals.stored, 0);
  EXPECT_EQ(rig.force(0), Vec2(0, 0));
}

}  // namespace
}  // namespace pliant
