// Forces of bonds: the engine against the reference solver.
#include <gtest/gtest.h>

#include <algorithm>

#include "bonds/bond_system.hpp"
#include "reference/bonds/bonds.hpp"
#include "reference/contact_crowd.hpp"
#include "support/figures.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr double bond_strength = 1, bond_cohesion = 1.5, bond_energy_1 = 0.03, bond_energy_2 = 0.05;

/// Bonds of unequal strengths, energies and stiffnesses, beside contact with friction: each term of the law counts.
BondRule full_bond_rule(double gap = 0) {
  BondRule rule;
  rule.first = rule.second = "all";
  rule.stiffness = kn, rule.shear_stiffness = 0.7 * kn;
  rule.strength = bond_strength, rule.cohesion = bond_cohesion;
  rule.fracture_energy = bond_energy_1, rule.shear_fracture_energy = bond_energy_2;
  rule.friction = 0.6;
  rule.gap = gap;
  return rule;
}

/// Friction of contact beside a bond: less than that of the bond, and the same.
constexpr double frictions[] = {0.3, 0.6};

/// Bonds under the higher friction fatigue.
Scene bonded(Scene scene, double friction, double gap = 0) {
  scene.contacts = {mohr_coulomb(130, friction)};
  scene.bonds = {full_bond_rule(gap)};
  BondRule& rule = scene.bonds[0];
  if (friction == frictions[1]) rule.fatigue_threshold = 0.2, rule.fatigue_rate = 0.3, rule.shear_fatigue_rate = 0.5;
  return scene;
}

/// Largest differences of all states that were compared, and what the states were.
struct ComparedBonds {
  double force = 0;   ///< over the largest force
  double energy = 0;  ///< stored, and lost in a step, J/m
  double damage = 0;
  double images = 0;            ///< of the forces on the vectors of the periods, over the largest force
  double stored = 0, lost = 0;  ///< J/m
  int softening = 0, torn = 0;  ///< ends, over all states
  std::size_t bonds = 0;
};

/// Both programs on one scene, at the same positions.
class BothBonds {
 public:
  explicit BothBonds(const Scene& scene)
      : rig(scene),
        engine_(rig.model, rig.contact.laws()),
        reference_(scene, reference_outlines(rig.model)),
        start_(scene) {
    engine_.make(rig.outlines.position, 0, history_);
    reference_.make(outline_points(rig), start_, 0);
    found.bonds = engine_.bonds().size();
    EXPECT_EQ(found.bonds, reference_.all().size());
  }

  void compare() {
    if (::testing::Test::HasFailure()) return;
    rig.show();
    BondHistory trial;
    OutlineField force(rig.model.outline_offset.back());
    const BondTotals totals = engine_.add_forces(rig.outlines.position, history_, trial, force);
    const reference::BondResult result = reference_.evaluate(outline_points(rig), start_);
    history_ = trial;
    reference_.accept();
    compare_forces(force, result);
    found.stored = std::max(found.stored, totals.stored), found.lost += totals.loss;
    found.energy =
        std::max({found.energy, std::abs(totals.stored - result.stored), std::abs(totals.loss - result.dissipated)});
    for (std::size_t bond = 0; bond < found.bonds; ++bond)
      for (const int end : {0, 1}) {
        const double damage = history_.damage(bond, end);
        found.damage = std::max(found.damage, std::abs(damage - of_reference(bond, end)));
        ++(damage == 1 ? found.torn : damage > 0 ? found.softening : untouched_);
      }
  }

  ContactRig rig;
  ComparedBonds found;

 private:
  /// Bonds stand in another order there.
  double of_reference(std::size_t bond, int end) const {
    const Bond& wanted = engine_.bonds()[bond];
    for (std::size_t i = 0; i < reference_.all().size(); ++i) {
      const reference::Bond& other = reference_.all()[i];
      if (other.slave == wanted.slave && other.master == wanted.master && other.segment == wanted.segment)
        return reference_.damage(i, static_cast<std::size_t>(end));
    }
    ADD_FAILURE() << "no bond of segment " << wanted.segment << " of body " << wanted.slave;
    return 0;
  }

  void compare_forces(const OutlineField& force, const reference::BondResult& result) {
    Points forces(outline_points(rig).size(), Vec2(0, 0));
    reference::add_forces(result, forces);
    double largest = 0, worst = 0;
    std::size_t node = 0;
    for (int body = 0; body < static_cast<int>(rig.model.bodies.size()); ++body)
      for (int k = 0; k < rig.count(body); ++k, ++node) {
        largest = std::max(largest, forces[node].norm());
        worst = std::max(worst, (force.at(rig.model.outline_offset[body] + k) - forces[node]).norm());
      }
    if (largest == 0) return;
    found.force = std::max(found.force, worst / largest);
    if (!rig.model.scene.cell) return;
    Eigen::Matrix2d pull = Eigen::Matrix2d::Zero();
    for (const reference::BondElement& element : result.elements)
      pull += element.lever.residual * Vec2(element.lever.image.x, element.lever.image.y).transpose();
    Eigen::Matrix2d engine;
    engine << force.lattice.ax, force.lattice.bx, force.lattice.ay, force.lattice.by;
    found.images = std::max(found.images, (pull + engine).norm() / largest);
  }

  BondSystem engine_;
  reference::Bonds reference_;
  reference::Periods start_;
  BondHistory history_;
  int untouched_ = 0;
};

/// A state of rest, and more that are stirred further and further.
void go_through_states(BothBonds& both, Random& random, int states = 20, double size = 0.015) {
  both.compare();
  for (int state = 0; state < states; ++state) {
    stir(both.rig, random, size);
    both.compare();
  }
}

/// INDEPENDENT: two programs at the same positions, with the same history. Tolerance: that of verify/frozen_states.
void expect_same(const ComparedBonds& found, const std::string& name, double friction) {
  LargestFigures figures;
  figures.note("bonds: " + name, found.force);
  EXPECT_LE(found.force, 1e-11) << name;
  EXPECT_LE(found.energy, 1e-11 * found.stored) << name;
  EXPECT_LE(found.damage, 1e-11) << name;
  EXPECT_LE(found.images, 1e-11) << name;
  EXPECT_GT(found.softening, 20) << name;
  if (friction < 1) EXPECT_GT(found.torn, 20) << name;
  EXPECT_GT(found.lost, 0) << name;
}

TEST(BondAgreement, cells_of_a_disc) {
  for (const double friction : frictions) {
    Scene scene = bare_scene();
    scene.shapes = {disc_shape("disc", 2, 200)};
    add_grain(scene, "disc", BodyKind::compliant, {0.3, -0.2}, 0.7);
    scene.grains[0].cells.assign(6, 1);
    Random random(1);
    BothBonds both(bonded(scene, friction));
    EXPECT_GT(both.found.bonds, 20u);
    go_through_states(both, random);
    expect_same(both.found, "cells of a disc", friction);
  }
}

/// Outlines of other spacings that do not match, with a gap and an angle between them, and an overhanging end.
TEST(BondAgreement, unmatched_outlines_with_a_gap) {
  Random random(2);
  for (const double friction : frictions)
    for (const BodyKind kind : {BodyKind::compliant, BodyKind::rigid}) {
      Scene scene = bare_scene();
      add_body(scene, outline_shape("", rectangle(1, 1, 0.21), 70), kind, {-0.5, 0}, 0.004);
      add_body(scene, outline_shape("", rectangle(1, 1.3, 0.31)), BodyKind::rigid, {0.53, 0.08}, 0.012);
      add_body(scene, polygonal_disc("", 1.1, 41), BodyKind::rigid, {-0.45, 1.06});
      BothBonds both(bonded(scene, friction, 0.05));
      EXPECT_GT(both.found.bonds, 5u);
      go_through_states(both, random);
      expect_same(both.found, "unmatched outlines with a gap", friction);
    }
}

/// Grains bonded to a wall and to each other over the border of the period, and several periods away from it.
TEST(BondAgreement, grains_on_a_wall_across_the_border) {
  Random random(3);
  for (const double friction : frictions)
    for (const double x : {0.3, 3.17, 6.1, -20.2}) {
      Scene scene = bare_scene();
      scene.period = 3;
      add_body(scene, outline_shape("", rectangle(1.5, 1, 0.11), 90), BodyKind::compliant, {x, 0.5});
      add_body(scene, outline_shape("", rectangle(1.5, 1, 0.13)), BodyKind::rigid, {x + 1.5, 0.5});
      scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 0.17), flat_wall("lid", Wall::Solid::above, 1, 0.14)};
      BothBonds both(bonded(scene, friction, 0.02));
      EXPECT_GT(both.found.bonds, 60u);
      go_through_states(both, random);
      expect_same(both.found, "grains on a wall across the border", friction);
    }
}

/// Squares bonded to each other over both borders of a cell.
TEST(BondAgreement, images_of_a_cell) {
  Random random(4);
  for (const double friction : frictions) {
    Scene scene = bare_scene();
    scene.cell.emplace();
    scene.cell->periods = {2, 2};
    for (const double x : {0.4, 1.4})
      for (const double y : {0.3, 1.3})
        add_body(scene, outline_shape("", rectangle(1, 1, x < 1 ? 0.1 : 0.125), 60),
                 y < 1 ? BodyKind::compliant : BodyKind::rigid, {x + 2 * (y > 1), y - 4 * (x > 1)});
    BothBonds both(bonded(scene, friction));
    EXPECT_GT(both.found.bonds, 70u);
    go_through_states(both, random);
    expect_same(both.found, "images of a cell", friction);
  }
}

}  // namespace
}  // namespace pliant
