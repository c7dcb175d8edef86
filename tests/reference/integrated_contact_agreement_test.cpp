// Contact as an integral over segments: the engine against the reference solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/contact_crowd.hpp"
#include "support/figures.hpp"

namespace pliant {
namespace {

using namespace testing;

Scene by_segments(Scene scene) {
  scene.contact.quadrature = ContactQuadrature::segments;
  scene.contact.energy_consistent = false;  // the reference solver has no energy correction
  scene.skin = 1;                           // so that no state asks for new candidates
  return scene;
}

struct Difference {
  double nodes = 0;   ///< of forces on nodes, the largest over the largest force
  double bodies = 0;  ///< of forces on bodies, the same
};

/// Both programs on one scene.
class BothIntegrals {
 public:
  explicit BothIntegrals(const Scene& scene) : rig(scene), contacts_(scene, reference_outlines(rig.model)) {}

  /// `moved`: from the last accepted state.
  void evaluate(bool moved) {
    rig.show();
    if (!moved) rig.refresh();
    ASSERT_TRUE(rig.contact.candidates_hold(rig.outlines.position));
    const StepStart start{rig.accepted_outlines, 1};
    rig.totals = rig.contact.forces(rig.outlines, rig.committed, rig.trial, rig.forces, moved ? &start : nullptr);
    result = contacts_.evaluate(outline_points(rig));
  }
  void accept() {
    rig.commit();
    rig.refresh();
    contacts_.accept();
  }
  Difference difference() const {
    const Points forces = forces_on_nodes(result, outline_points(rig).size());
    Difference found;
    double largest = 0;
    std::size_t node = 0;
    for (int body = 0; body < static_cast<int>(rig.model.bodies.size()); ++body) {
      Vec2 sum(0, 0);
      for (int k = 0; k < rig.count(body); ++k, ++node) {
        const Vec2 off = rig.force(body, k) - forces[node];
        largest = std::max(largest, forces[node].norm());
        found.nodes = std::max(found.nodes, off.norm());
        sum += off;
      }
      found.bodies = std::max(found.bodies, sum.norm());
    }
    if (largest > 0) found.nodes /= largest, found.bodies /= largest;
    return found;
  }

  ContactRig rig;
  reference::ContactResult result;

 private:
  reference::Contacts contacts_;
};

Scene random_outlines(Random& random, const ContactRule& rule, int sample) {
  Scene scene = bare_scene();
  scene.contacts = {rule};
  add_random_body(scene, random, sample % 5);
  add_random_body(scene, random, sample / 5 % 5);
  return by_segments(scene);
}

struct Law {
  const char* name;
  ContactRule rule;
};

/// Nothing acts across a gap: no fan but those of re-entrant nodes counts.
std::vector<Law> touching_laws() {
  return {{"frictionless", frictionless(100)},
          {"frictionless, smoothed", smoothed(frictionless(100), 0.1)},
          {"mohr-coulomb", mohr_coulomb(100, 0.3)},
          {"mohr-coulomb, smoothed", smoothed(mohr_coulomb(100, 0.3, 0.05), 0.1)},
          {"mohr-coulomb, sticking", mohr_coulomb(100, 30, 10)}};
}
std::vector<Law> reaching_laws() {
  return {{"mohr-coulomb with tension", mohr_coulomb(100, 0.3, 0.05, 0.2)},
          {"cohesive", cohesive(100, 0.5, 0.02, 0.4)}};
}

// Outside, integrals in fans are in closed form, or three Gauss points will do. Inside these are off by rho^-6, rho
// + 1/rho twice the distances of a part's ends from the node over the part's length: 3e-3 where one distance is five
// times the other, unless the integrand is linear.
constexpr double in_fans_outside = 1e-8, in_fans_inside = 3e-3;

/// Of all states that were compared.
struct Comparison {
  std::vector<double> nodes, bodies;
  double stored = 0, dissipated = 0;  ///< largest difference, J/m
  double energy = 0;                  ///< most that a state stored, J/m
  double lost = 0;                    ///< most by one state's contacts, J/m

  void add(const BothIntegrals& both) {
    const Difference found = both.difference();
    nodes.push_back(found.nodes), bodies.push_back(found.bodies);
    stored = std::max(stored, std::abs(both.rig.totals.stored - both.result.stored));
    dissipated = std::max(dissipated, std::abs(both.rig.totals.dissipated - both.result.dissipated));
    energy = std::max(energy, std::abs(both.result.stored));
    lost = std::max(lost, both.result.dissipated);
  }
  /// A first state, accepted, and more, each moved by part of a segment.
  void add_states(BothIntegrals& both, Random& random) {
    both.evaluate(false);
    add(both);
    both.accept();
    for (int state = 0; state < 4; ++state) {
      stir(both.rig, random, 0.003);
      both.evaluate(true);
      add(both);
      both.accept();
    }
  }

  /// INDEPENDENT: two programs. Tolerance: that of verify/frozen_states; energies, of order 0.1, the same.
  void expect_same(const std::string& name) {
    LargestFigures figures;
    figures.note("integrated contact: " + name, *std::ranges::max_element(nodes));
    EXPECT_LE(*std::ranges::max_element(nodes), 1e-11);
    EXPECT_LE(stored, 1e-12);
    EXPECT_LE(dissipated, 1e-12);
  }
  /// INDEPENDENT: the same two. Both have quadratures in fans: the engine's are off by so much of what a fan carries.
  void expect_close(double in_fans) {
    EXPECT_LE(*std::ranges::max_element(nodes), in_fans);
    EXPECT_LE(stored, in_fans * energy);
    EXPECT_LE(dissipated, in_fans * lost);
  }
};

Comparison compare_random_outlines(const ContactRule& rule) {
  Comparison all;
  for (int sample = 0; sample < 100; ++sample) {
    Random random(sample + 1);
    BothIntegrals both(random_outlines(random, rule, sample));
    press_together(both.rig, random, random.uniform(0.005, 0.03));
    all.add_states(both, random);
  }
  return all;
}

TEST(IntegratedContact, EngineAgreesOnRandomOutlines) {
  for (const auto& [name, rule] : touching_laws()) {
    SCOPED_TRACE(name);
    Comparison all = compare_random_outlines(rule);
    all.expect_same(std::string(name) + ", random outlines");
    EXPECT_EQ(all.lost > 1e-6, rule.law != ContactLawKind::frictionless);
  }
}

TEST(IntegratedContact, EngineAgreesAcrossGapsWithoutShear) {
  for (const ContactRule& rule : {mohr_coulomb(100, 0, 0, 0.2), cohesive(100, 0.5, 0.02, 0)}) {
    Comparison all = compare_random_outlines(rule);
    all.expect_close(in_fans_outside);
  }
}

TEST(IntegratedContact, EngineAgreesAcrossGaps) {
  for (const auto& [name, rule] : reaching_laws()) {
    SCOPED_TRACE(name);
    Comparison all = compare_random_outlines(rule);
    all.expect_close(in_fans_outside);
    EXPECT_GT(all.lost, 1e-6);
  }
}

// Walls and images, compliant bodies, and lengths of either kind.
TEST(IntegratedContact, EngineAgreesInACrowd) {
  const auto compare = [](const ContactRule& rule) {
    Comparison all;
    for (int sample = 0; sample < 20; ++sample) {
      Random random(sample + 1000);
      Scene scene = crowd(random, {rule}, sample % 2 == 0);
      if (sample % 4 < 2) scene.contact.length = ContactLength::current;
      BothIntegrals both(by_segments(scene));
      all.add_states(both, random);
    }
    return all;
  };
  for (const auto& [name, rule] : touching_laws()) {
    SCOPED_TRACE(name);
    compare(rule).expect_same(std::string(name) + ", a crowd");
  }
  for (const auto& [name, rule] : reaching_laws()) {
    SCOPED_TRACE(name);
    compare(rule).expect_close(in_fans_outside);
  }
}

// A disc or a block against its own image, the block wider than the period on its floor. Deformed, a block has
// re-entrant nodes on its faces, and couples of shear in their fans.
TEST(IntegratedContact, EngineAgreesOnOwnImages) {
  const auto compare = [](const ContactRule& rule) {
    Comparison all;
    for (int sample = 0; sample < 20; ++sample) {
      Random random(sample + 60);
      const bool deforms = rule.law == ContactLawKind::frictionless && sample % 2 == 0;
      BothIntegrals both(by_segments(lone_body(random, deforms ? BodyKind::compliant : BodyKind::rigid, rule)));
      all.add_states(both, random);
    }
    return all;
  };
  for (const auto& [name, rule] : touching_laws()) {
    SCOPED_TRACE(name);
    compare(rule).expect_same(std::string(name) + ", own images");
  }
}

// A tip in a re-entrant corner: most of what touches is in its fan. Without smoothing p n is linear there.
TEST(IntegratedContact, EngineAgreesInANotch) {
  const auto compare = [](const ContactRule& rule) {
    Comparison all;
    for (int sample = 0; sample < 50; ++sample) {
      Random random(sample + 9000);
      Scene scene = bare_scene();
      scene.contacts = {rule};
      Points notched = regular(6, 1), needle{{0, 0}, {3, 4}, {-3, 4}};
      notched[1] *= random.uniform(0.1, 0.3);
      add_body(scene, outline_shape("notched", notched), BodyKind::rigid, {0, 0}, M_PI / 6);
      add_body(scene, outline_shape("needle", needle), BodyKind::rigid, {0, 0}, random.uniform(-0.2, 0.2));
      BothIntegrals both(by_segments(scene));
      const double direction = random.uniform(-0.4, 0.4), depth = random.uniform(0.01, 0.05);
      both.rig.move(1,
                    both.rig.node(0, 1) - both.rig.node(1, 0) - depth * Vec2(std::sin(direction), std::cos(direction)));
      all.add_states(both, random);
    }
    return all;
  };
  compare(frictionless(100)).expect_same("a needle in a notch");
  for (const ContactRule& rule : {smoothed(frictionless(100), 0.1), mohr_coulomb(100, 0.3), mohr_coulomb(100, 30, 10)})
    compare(rule).expect_close(in_fans_inside);
}

// INDEPENDENT: below a step of 0.1 points are beyond the bisector of its upper corner, but nearer to the top than to
// the step's face or foot. Rounding, as of the others.
TEST(IntegratedContact, EngineAgreesBesideShortEdges) {
  for (const double spacing : {2.0, 0.2, 0.15})
    for (const double height : {-0.02, -0.05, -0.08}) {
      Scene scene = bare_scene();
      scene.contacts = {frictionless(100)};
      const Points step{{-1, -1}, {1, -1}, {1, 0.1}, {0, 0.1}, {0, 0}, {-1, 0}},
          block{{0.1, 0}, {0.4, 0}, {0.4, 1}, {0.1, 1}};
      add_body(scene, outline_shape("step", refined(step, spacing)), BodyKind::rigid, {0, 0});
      add_body(scene, outline_shape("block", block), BodyKind::rigid, {0, 0}, 0.01);
      BothIntegrals both(by_segments(scene));
      both.rig.move(0, Vec2(-1, -1) - both.rig.node(0, 0));
      both.rig.move(1, Vec2(0.1, height) - both.rig.node(1, 0));
      Comparison all;
      both.evaluate(false);
      all.add(both);
      EXPECT_GT(all.energy, 0.1);
      all.expect_same("beside short edges");
    }
}

}  // namespace
}  // namespace pliant
