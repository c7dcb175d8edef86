// Contact of the engine against that of the reference solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/contact_crowd.hpp"
#include "support/figures.hpp"

namespace pliant {
namespace {

using namespace testing;

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
  std::vector<ContactRule> rules;
  bool shears = true;
};

ContactRule between(const char* first, const char* second, ContactRule rule) {
  rule.first = first, rule.second = second;
  return rule;
}

// Walls by name, and automatic stiffness in pairs of every sort.
std::vector<ContactRule> several_rules() {
  return {between("soft", "hard", automatic(mohr_coulomb(0, 0.3))),
          between("soft", "softer", automatic(cohesive(0, 0.3, 0.02, 0.4))),
          between("floor", "hard", automatic(mohr_coulomb(0, 0.5))),
          between("lid", "all", cohesive(100, 0.5, 0.03, 0.4)), automatic(frictionless(0))};
}

std::vector<Case> cases() {
  return {{"frictionless", {frictionless(100)}, false},
          {"frictionless, smoothed", {smoothed(frictionless(100), 0.05)}, false},
          {"mohr-coulomb", {mohr_coulomb(100, 0.3)}},
          {"mohr-coulomb, smoothed", {softer_in_shear(smoothed(mohr_coulomb(100, 0.3, 0.05), 0.1))}},
          {"mohr-coulomb with tension", {mohr_coulomb(100, 0.3, 0.05, 0.2)}},
          {"mohr-coulomb, automatic", {automatic(mohr_coulomb(0, 0.3))}},
          {"cohesive", {softer_in_shear(cohesive(100, 0.5, 0.02, 0.4))}},
          {"cohesive, automatic", {automatic(cohesive(0, 0.3, 0.02, 0.4))}},
          {"several rules", several_rules()}};
}

constexpr int single_rules = 8;  // the first cases

class Sides {
 public:
  explicit Sides(const Scene& scene) : rig(scene), contacts(scene, reference_outlines(rig.model)) {}

  void evaluate() {
    EXPECT_FALSE(rig.evaluate());
    result = contacts.evaluate(outline_points(rig));
  }
  void accept() {
    rig.commit();
    rig.refresh();
    contacts.accept();
  }

  /// INDEPENDENT: two programs. Tolerances: that of verify/frozen_states; energies, of order 0.1, the same.
  void expect_agreement() {
    const Points forces = forces_on_nodes(result, outline_points(rig).size());
    double largest = 0, worst = 0;
    std::size_t node = 0;
    for (int body = 0; body < static_cast<int>(rig.model.bodies.size()); ++body)
      for (int k = 0; k < rig.count(body); ++k, ++node) {
        largest = std::max(largest, forces[node].norm());
        worst = std::max(worst, (rig.force(body, k) - forces[node]).norm());
      }
    EXPECT_LE(worst, 1e-11 * largest);
    if (largest > 0) difference = std::max(difference, worst / largest);
    EXPECT_EQ(rig.totals.contacts, static_cast<int>(result.elements.size()));
    EXPECT_NEAR(rig.totals.stored, result.stored, 1e-12);
    EXPECT_NEAR(rig.totals.dissipated, result.dissipated, 1e-12);
  }

  ContactRig rig;
  reference::Contacts contacts;
  reference::ContactResult result;
  double difference = 0;  ///< the largest of forces, relative
};

struct Seen {
  int contacts = 0;
  double sheared = 0, dissipated = 0;
};

// A first state, accepted, and several more, each moved by part of a segment.
Seen compare_states(Sides& sides, Random& random, double size) {
  Seen seen;
  sides.rig.refresh();
  sides.evaluate();
  sides.expect_agreement();
  sides.accept();
  for (int state = 0; state < 4 && !::testing::Test::HasFailure(); ++state) {
    SCOPED_TRACE(state);
    stir(sides.rig, random, state < 2 ? size : 3 * size);
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
  LargestFigures figures;
  for (const Case& law : cases()) {
    SCOPED_TRACE(law.name);
    Seen all;
    for (int sample = 0; sample < 20 && !HasFailure(); ++sample) {
      SCOPED_TRACE(sample);
      Random random(sample + 1000);
      Sides sides(crowd(random, law.rules, sample % 2 == 0));
      const Seen seen = compare_states(sides, random, 0.01);
      figures.note(std::string("contact forces: ") + law.name, sides.difference);
      all.contacts += seen.contacts;
      all.sheared += seen.sheared;
      all.dissipated += seen.dissipated;
    }
    if (HasFailure()) continue;
    EXPECT_GT(all.contacts, 500);
    EXPECT_EQ(all.sheared > 1, law.shears);
    EXPECT_EQ(all.dissipated > 0.01, law.shears);
  }
}

// Outlines with sharp, re-entrant and flat corners, which the crowd has not.
TEST(ReferenceContact, EngineAgreesOnRandomOutlines) {
  LargestFigures figures;
  int compared = 0;
  for (int sample = 0; sample < 300 && !HasFailure(); ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 5000);
    Scene scene = nodal_scene();
    scene.contact.energy_consistent = false;  // the reference solver has no energy correction
    scene.skin = 1;
    scene.contacts = cases()[sample % single_rules].rules;
    if (!scene.contacts[0].stiffness) continue;  // needs a compliant body
    for (int body = 0; body < 2; ++body)
      add_random_body(scene, random, (sample / single_rules + body * (1 + sample / 55)) % 5);
    Sides sides(scene);
    press_together(sides.rig, random, 0.03);
    compared += compare_states(sides, random, 0.003).contacts > 0;
    figures.note("contact forces: random outlines", sides.difference);
  }
  EXPECT_GT(compared, 200);
}

// A tip in a re-entrant corner, most of the time behind its end node: nothing else stands beyond an end inside a body.
TEST(ReferenceContact, EngineAgreesInANotch) {
  LargestFigures figures;
  int beyond = 0;
  for (int sample = 0; sample < 220 && !HasFailure(); ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 9000);
    Scene scene = nodal_scene();
    scene.contact.energy_consistent = false;  // the reference solver has no energy correction
    scene.skin = 0.1;
    scene.contacts = cases()[sample % single_rules].rules;
    scene.contacts[0].stiffness = 100;
    Points notched = regular(6, 1), needle{{0, 0}, {3, 4}, {-3, 4}};
    notched[1] *= random.uniform(0.1, 0.3);
    add_body(scene, outline_shape("notched", notched), BodyKind::rigid, {0, 0}, M_PI / 6);
    add_body(scene, outline_shape("needle", needle), BodyKind::rigid, {0, 0}, random.uniform(-0.2, 0.2));
    Sides sides(scene);
    const double direction = random.uniform(-0.4, 0.4), depth = random.uniform(-0.01, 0.05);
    sides.rig.move(
        1, sides.rig.node(0, 1) - sides.rig.node(1, 0) - depth * Vec2(std::sin(direction), std::cos(direction)));
    compare_states(sides, random, 0.003);
    figures.note("contact forces: a needle in a notch", sides.difference);
    beyond += std::abs(direction) < 0.2 && depth > 0.01;
  }
  EXPECT_GT(beyond, 50);
}

}  // namespace
}  // namespace pliant
