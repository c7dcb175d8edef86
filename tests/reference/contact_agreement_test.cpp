// Contact of the engine against that of the reference solver (VERIFICATION 3a).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/contact_pair.hpp"

namespace pliant {
namespace {

using namespace testing;

ContactRule wearing_bonds() {
  ContactRule rule = cohesive_fatigue(100, 0.5, 0.03, 1.25, 0.004);
  rule.fatigue_threshold = 0.1;
  rule.fatigue_rate = 0.6;
  rule.shear_fatigue_rate = 1.1;
  return rule;
}

ContactRule bonds_with_a_rest() {
  ContactRule rule = wearing_bonds();
  rule.residual_strength = 0.2;
  rule.friction = 0.4;
  return rule;
}

ContactRule softer_in_shear(ContactRule rule) {
  rule.shear_stiffness = 60;
  return rule;
}

ContactRule automatic(ContactRule rule) {
  rule.stiffness.reset();
  if (rule.range) rule.range.reset();
  return rule;
}

struct Case {
  const char* name;
  ContactRule rule;
  bool shears = true, damages = false;
};

std::vector<Case> cases() {
  return {{"frictionless", frictionless(100), false},
          {"frictionless, smoothed", smoothed(frictionless(100), 0.05), false},
          {"mohr-coulomb", mohr_coulomb(100, 0.3)},
          {"mohr-coulomb, smoothed", softer_in_shear(smoothed(mohr_coulomb(100, 0.3, 0.05), 0.1))},
          {"mohr-coulomb with tension", mohr_coulomb(100, 0.3, 0.05, 0.2)},
          {"mohr-coulomb, automatic", automatic(mohr_coulomb(0, 0.3))},
          {"cohesive", softer_in_shear(cohesive(100, 0.5, 0.02, 0.4))},
          {"cohesive, automatic", automatic(cohesive(0, 0.3, 0.02, 0.4))},
          {"cohesive-fatigue", cohesive_fatigue(100, 0.5, 0.03, 1.25, 0.004), true, true},
          {"cohesive-fatigue, wear", wearing_bonds(), true, true},
          {"cohesive-fatigue, residual strength", bonds_with_a_rest(), true, true}};
}

// Discs and a square in a row across the period, on a wall with caps or a flat one, two or three bodies overlapping each other.
Scene crowd(Random& random, const ContactRule& rule, bool caps) {
  Scene scene = bare_scene();
  scene.contacts = {rule};
  scene.period = 4.45;
  scene.skin = 1;  // so that no state asks for new candidates: the engine finds them at accepted states only
  const double turn = random.uniform(0, 6), x = random.uniform(-20, 20), y = caps ? 0.99 : 0.79;
  add_body(scene, disc_shape("disc", 1.6, 30, 60), BodyKind::compliant, {x, y}, turn);
  add_body(scene, outline_shape("square", rectangle(1.3, 1.3, 0.13)), BodyKind::rigid, {x + 1.46, y - 0.13},
           random.uniform(-0.01, 0.01));
  add_body(scene, outline_shape("disc", regular(37, 0.8)), BodyKind::rigid, {x + 2.9, y}, -turn);
  // In the gap above: overlaps the discs, one of them across the period.
  add_body(scene, disc_shape("disc", 1.2, 30, 60), BodyKind::compliant, {x - 0.775, y + 1.15}, 2 * turn);
  scene.walls = {flat_wall("floor", Wall::Solid::below, caps ? -0.26 : 0.0, 0.15),
                 flat_wall("lid", Wall::Solid::above, y + 1.745, 0.11)};
  if (caps) scene.walls[0].caps = Caps{0.9, 4, 0.2, {0, 0.02}, {0.8, 0.5}};
  return scene;
}

void stir(ContactRig& rig, Random& random, double size) {
  const auto by = [&] { return random.uniform(-size, size); };
  for (std::size_t b = 0; b < rig.model.bodies.size(); ++b) {
    rig.move(static_cast<int>(b), {by(), by() / 2});
    if (rig.model.bodies[b].kind == BodyKind::rigid && !rig.model.bodies[b].wall) rig.turn(static_cast<int>(b), by());
  }
  for (const Batch& batch : rig.model.batches)
    for (int i = 0; i < 2 * rig.model.shape_of(batch).nodes(); ++i)
      for (int lane = 0; lane < batch.count; ++lane) rig.q.compliant[batch.offset + i][lane] += by() / 8;
}

class Sides {
 public:
  explicit Sides(const Scene& scene) : rig(scene), contacts(scene, reference_outlines(rig.model)) { rig.refresh(); }

  void evaluate() {
    EXPECT_FALSE(rig.evaluate());
    result = contacts.evaluate(outline_points(rig));
  }
  void accept() {
    rig.commit();
    rig.refresh();
    contacts.accept();
  }
  double largest_force() const {
    double largest = 0;
    for (const Vec2& force : reference_forces()) largest = std::max(largest, force.norm());
    return largest;
  }
  Points reference_forces() const { return forces_of(result, outline_points(rig).size()); }

  /// INDEPENDENT: two programs. Tolerance: that of VERIFICATION 3a.
  void expect_agreement() const {
    const double largest = largest_force();
    EXPECT_GT(largest, 0.01);
    const Points forces = reference_forces();
    std::size_t node = 0;
    for (std::size_t b = 0; b < rig.model.bodies.size(); ++b)
      for (int k = 0; k < rig.count(static_cast<int>(b)); ++k, ++node)
        EXPECT_LT((rig.force(static_cast<int>(b), k) - forces[node]).norm(), 1e-11 * largest)
            << rig.model.bodies[b].name << ", node " << k;
    EXPECT_EQ(rig.totals.contacts, static_cast<int>(result.elements.size()));
    EXPECT_NEAR(rig.totals.stored, result.stored, 1e-12);
    EXPECT_NEAR(rig.totals.dissipated, result.dissipated, 1e-12);
  }

  ContactRig rig;
  reference::Contacts contacts;
  reference::ContactResult result;
};

struct Seen {
  int contacts = 0, torn = 0;
  double sheared = 0, dissipated = 0;
};

// A first state, accepted, and several more, each moved by part of a segment.
Seen compare(const Case& law, int sample) {
  Random random(sample + 1000);
  Sides sides(crowd(random, law.rule, sample % 2 == 0));
  Seen seen;
  sides.evaluate();
  sides.expect_agreement();
  sides.accept();
  for (int state = 0; state < 4 && !::testing::Test::HasFailure(); ++state) {
    SCOPED_TRACE(state);
    stir(sides.rig, random, state < 2 ? 0.01 : 0.03);
    sides.evaluate();
    sides.expect_agreement();
    seen.contacts += static_cast<int>(sides.result.elements.size());
    for (const reference::ContactElement& element : sides.result.elements) seen.sheared += std::abs(element.shear);
    seen.dissipated += sides.result.dissipated;
    sides.accept();
  }
  return seen;
}

TEST(ReferenceContact, EngineAgreesForAllLaws) {
  for (const Case& law : cases()) {
    SCOPED_TRACE(law.name);
    Seen all;
    for (int sample = 0; sample < 20 && !HasFailure(); ++sample) {
      SCOPED_TRACE(sample);
      const Seen seen = compare(law, sample);
      all.contacts += seen.contacts;
      all.sheared += seen.sheared;
      all.dissipated += seen.dissipated;
    }
    if (HasFailure()) continue;
    EXPECT_GT(all.contacts, 1000);
    EXPECT_EQ(all.sheared > 1, law.shears);
    EXPECT_EQ(all.dissipated > 0.01, law.shears);
  }
}

}  // namespace
}  // namespace pliant
