// Sharp corners: over which length faces touch there, and that nothing locks.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "contact/contact_points.hpp"
#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr double block_depth = 0.004;

/// A block of unit width over a longer bar, face to face and `block_depth` inside, shifted along it.
Scene shifted_block_on_bar(const ContactRule& rule, int segments, double bar_spacing, double shift,
                           bool compliant = false) {
  Scene scene = bare_scene();
  scene.contacts = {rule};
  add_body(scene, outline_shape("bar", rectangle(2.4, 0.5, bar_spacing)), BodyKind::rigid, {0, 0});
  add_body(scene,
           outline_shape("block", rectangle(1, 0.5, 1.0 / segments),
                         compliant ? std::optional(segments * segments + 14) : std::nullopt),
           compliant ? BodyKind::compliant : BodyKind::rigid, {shift, 0.5 - block_depth});
  return scene;
}

const double spacings[] = {0.25, 0.1, 1.0 / 16, 0.037};

/// The length that a bar of half width 1.2 and a block of half width 0.5 share.
double shared(double shift) { return std::max(0.0, std::min(0.5 + shift, 1.2) - std::max(shift - 0.5, -1.2)); }

// EXACT: flat faces press over the length L that they share, wherever their nodes are, aligned or not, and whoever is
// finer. At either end, of the block on the bar or of the bar under the block, the pass of the one whose end it is adds
// the side that is inside, kn d^2/4, and that of the other loses twice as much to the side, to which its points are
// nearer there: kn d (L - d/2) in all, and an energy of kn d^2/2 (L - d/3). Off the bar's end the block is pushed by
// the derivative of that along the way, kn d^2/2. Rounding of 40 nodes' forces.
TEST(Corners, FlatFacesTouchOverWhatTheyShare) {
  const double energy = 0.5 * kn * block_depth * block_depth;
  for (const int segments : {4, 6, 8, 16})
    for (const double spacing : spacings)
      for (const double shift : {0.0, 0.1, 0.0317, -0.25, 0.9, -1.03, 1.45, -1.53})
        for (const bool compliant : {false, true}) {
          if (compliant && segments > 8) continue;  // enough
          SCOPED_TRACE(fmt::format("{} segments, spacing {}, shift {}, {}", segments, spacing, shift, compliant));
          ContactRig rig(shifted_block_on_bar(frictionless(kn), segments, spacing, shift, compliant));
          rig.evaluate();
          EXPECT_NEAR(rig.force(1).y(), kn * block_depth * (shared(shift) - block_depth / 2), 1e-12);
          EXPECT_NEAR(rig.totals.stored, energy * (shared(shift) - block_depth / 3), 1e-14);
          const double off = shift > 0.7 ? energy : shift < -0.7 ? -energy : 0;
          EXPECT_NEAR(rig.force(1).x(), off, 1e-12);
        }
}

// EXACT: the strength of a face is that of its length, and of what is within reach at both ends: the side above one,
// and what lies past the other, at distances r, which pull by the upright part gap/r of their direction.
TEST(Corners, AFaceIsAsStrongAsItIsLong) {
  const double strength = 0.5, reach = 0.03, gap = strength / kn;
  const auto pull = [&](double r) { return strength * (reach - r) / (reach - gap); };
  double past_end = 0;
  constexpr int parts = 100'000;
  const double widest = std::sqrt(reach * reach - gap * gap);
  for (int i = 0; i < parts; ++i) {
    const double r = std::hypot(gap, (i + 0.5) / parts * widest);
    past_end += pull(r) * gap / r * widest / parts;
  }
  const double of_side = 0.5 * strength * (reach - gap), of_ends = of_side + past_end;  // two ends, each half a pass
  for (const int segments : {4, 6, 16})
    for (const double spacing : spacings)
      for (const double shift : {0.0, 0.0317, 0.62}) {
        ContactRig rig(shifted_block_on_bar(cohesive(kn, strength, reach, 0), segments, spacing, shift));
        rig.move(1, {0, block_depth + gap});
        rig.evaluate();
        // The sum's points: kinks cost the square of a part.
        EXPECT_NEAR(-rig.force(1).y(), strength * shared(shift) + of_ends, 1e-9) << segments << " " << spacing;
      }
}

// EXACT: a block that slides over a bar, past its nodes and off its end, meets no barrier: the work along the way is
// the energy's change, and on the bar no step meets more than rounding.
TEST(Corners, NothingLocks) {
  for (const double spacing : spacings) {
    ContactRig rig(shifted_block_on_bar(frictionless(kn), 8, spacing, -0.6));
    double largest = 0;
    for (int step = 0; step < 500; ++step) {
      rig.step();
      largest = std::max(largest, std::abs(rig.force(1).x()));
      rig.move(1, {0.0025, 0});
    }
    EXPECT_LT(largest, 1e-12) << spacing;
  }
}

// EXACT: a square corner that pokes into a flat face by d. Each of its sides is inside over d sqrt(2), at d/2 in the
// mean; the face is inside it over 2 d, at (d - |x|)/sqrt(2) from a side that pushes by 1/sqrt(2) upwards: kn d^2
// (1/sqrt(2) + 1/4), whatever the nodes.
TEST(Corners, ACornerPokesByTheSquareOfItsDepth) {
  for (const double spacing : {0.5, 0.013, 0.003}) {
    Scene scene = bare_scene();
    scene.contacts = {frictionless(kn)};
    add_body(scene, outline_shape("bar", rectangle(3, 0.5, spacing)), BodyKind::rigid, {0, 0});
    add_body(scene, outline_shape("block", rectangle(1, 1, 0.1)), BodyKind::rigid, {0, 0}, M_PI / 4);
    ContactRig rig(scene);
    rig.move(1, {0.0017, 0.25 + std::sqrt(0.5) - block_depth});
    rig.evaluate();
    EXPECT_NEAR(rig.force(1).x(), 0, 1e-12);
    EXPECT_NEAR(rig.force(1).y(), kn * block_depth * block_depth * (std::sqrt(0.5) + 0.25), 1e-12);
  }
}

// EXACT: corner against corner, head on and aside, a contact there is, and it pushes them apart; a tip of another angle
// too.
TEST(Corners, CornersMeet) {
  for (const double half_angle : {45.0, 20.0, 60.0})
    for (const double aside : {0.0, 0.003, -0.006})
      for (const double turn : {0.0, 0.1}) {
        SCOPED_TRACE(fmt::format("{} degrees, {} aside, turned by {}", half_angle, aside, turn));
        Scene scene = bare_scene();
        scene.contacts = {frictionless(kn)};
        const double wide = std::tan(half_angle * M_PI / 180);
        add_body(scene, outline_shape("square", rectangle(1, 1, 0.1)), BodyKind::rigid, {0, 0}, M_PI / 4);
        add_body(scene, outline_shape("tip", {{0, 0}, {wide, 1}, {-wide, 1}}), BodyKind::rigid, {0, 0}, turn);
        ContactRig rig(scene);
        rig.show();
        const Vec2 place(aside, std::sqrt(0.5) - 0.02);
        rig.move(1, place - rig.node(1, 0));
        rig.evaluate();
        EXPECT_GT(rig.totals.contacts, 0);
        EXPECT_GT(rig.force(1).y(), 0.1 * kn * 0.01 * 0.05);
        EXPECT_LT((rig.force(0) + rig.force(1)).norm(), 1e-14);
      }
}

/// A random square or octagon of segments of a length, and how its corner 0 moves past one of a square's: over two
/// segments, straight, by up to one beside it.
struct Passage {
  Passage(Random& random, double segment, double stiffness) {
    scene = bare_scene();
    scene.contacts = {frictionless(stiffness)};
    add_body(scene, outline_shape("square", rectangle(1.6, 1.6, segment)), BodyKind::rigid, {0, 0},
             random.uniform(0, 2 * M_PI));
    const Points other = random.below(2) == 0 ? rectangle(1.6, 1.6, segment) : refined(regular(8, 1, 0), segment);
    add_body(scene, outline_shape("other", other), BodyKind::rigid, {0, 0}, random.uniform(0, 2 * M_PI));
    const auto direction = [&] {
      const double angle = random.uniform(0, 2 * M_PI);
      return Vec2(std::cos(angle), std::sin(angle));
    };
    way = 2 * segment * direction();
    start = random.uniform(0, 1) * segment * direction() - 0.5 * way;
  }
  Scene scene;
  Vec2 way, start;  ///< from the square's corner
};

// RATE: wherever corners pass each other, on whichever faces, the energy changes by the work of the forces: no jump.
// Where faces or lengths change, forces turn, by about what a few segments carry at this depth, 4 k l d; of the energy
// 1/2 k l d^2, over a step h, an eighth of that is h / d. When a corner touched its nearest face, whatever it stood for
// there, two thirds of that energy came and went.
TEST(Corners, PassWithoutJumps) {
  constexpr double segment = 0.2, deep = 0.1 * segment, unit = 0.5 * kn * segment * deep * deep;
  constexpr int steps = 4000;
  Random random(7);
  int touched = 0;
  for (int sample = 0; sample < 80; ++sample) {
    const Passage passage(random, segment, kn);
    ContactRig rig(passage.scene);
    rig.move(1, rig.node(0, 0) + passage.start - rig.node(1, 0));
    double stored = 0, work = 0;
    for (int k = 0; k <= steps; ++k) {
      rig.evaluate();
      const double now = rig.totals.stored, pull = rig.force(1).dot(passage.way / steps);
      if (k > 0 && std::max(now, stored) < 2 * unit) {
        EXPECT_NEAR(now - stored, -(work + pull) / 2, passage.way.norm() / steps / deep * unit) << sample << ": " << k;
        touched += now > 0.1 * unit;
      }
      stored = now, work = pull;
      rig.move(1, passage.way / steps);
    }
  }
  EXPECT_GT(touched, 2 * steps);
}

/// What the nodes of body 0 store in their contacts, J/m.
double stored_by_first(const ContactRig& rig) {
  double energy = 0;
  for (const TouchingPair& pair : inspect_contacts(rig.model, rig.contact, rig.outlines, rig.trial))
    for (const ContactPoint& point : pair.points)
      if (point.slave == 0) energy += 0.25 * kn * point.length * point.gap * point.gap;
  return energy;
}

// RATE: the same of a corner that moves over the bottom of a notch, which is none: which of its sides count goes by the
// outline's direction there, that turns from one flank to the other without a jump. When it went by the flank that the
// corner was nearest to, the lesser side's part of the energy came and went at the bottom. What the notch's own nodes
// store beside the corner is another matter (docs/limits.md), and is let go.
TEST(Corners, PassANotchWithoutJumps) {
  constexpr double segment = 0.2, deep = 0.1 * segment, unit = 0.5 * kn * segment * deep * deep;
  constexpr int steps = 1000;
  Random random(8);
  int touched = 0;
  for (int sample = 0; sample < 40; ++sample) {
    const double rise = 3 * std::tan(random.uniform(0.05, 0.5)), shift = random.uniform(-0.3, 0.3);
    Scene scene = bare_scene();
    scene.contacts = {frictionless(kn)};
    const Points notched{{shift, 0}, {-3, rise}, {-3, -1}, {3, -1}, {3, rise}};
    add_body(scene, outline_shape("notched", refined(notched, random.uniform(0.07, 0.3))), BodyKind::rigid, {0, 0});
    add_body(scene, outline_shape("other", refined(regular(6, 1, 0), segment)), BodyKind::rigid, {0, 0},
             random.uniform(0, 2 * M_PI));
    ContactRig rig(scene);
    int lowest = 0;
    for (int i = 0; i < rig.count(1); ++i)
      if (rig.node(1, i).y() < rig.node(1, lowest).y()) lowest = i;
    const Vec2 way(0.5 * segment, 0), below(0, -random.uniform(0.3, 1) * deep);
    rig.move(1, rig.node(0, 0) + below - 0.5 * way - rig.node(1, lowest));
    double stored = 0, work = 0, by_notch = 0;
    for (int k = 0; k <= steps; ++k) {
      rig.evaluate();
      const double now = rig.totals.stored, pull = rig.force(1).dot(way / steps), aside = stored_by_first(rig);
      if (k > 0 && std::max(now, stored) < 2 * unit) {
        EXPECT_NEAR(now - stored, -(work + pull) / 2, way.norm() / steps / deep * unit + std::abs(aside - by_notch))
            << sample << ": " << k;
      }
      touched += now > 0.1 * unit;
      stored = now, work = pull, by_notch = aside;
      rig.move(1, way / steps);
    }
  }
  EXPECT_GT(touched, 20 * steps);
}

// EXACT: a tip in the top of a bar, beside its flank, that goes to and fro where it changes from the one to the other:
// off the bisector, as both its sides count on the top. What is stored, dissipated and done as work stays together; a
// way counted at each change would make as much from nothing.
TEST(Corners, FacesChangedAreNoSlip) {
  constexpr double segment = 0.1, deep = 0.05 * segment;
  constexpr int steps = 200;
  for (const double friction : {0.2, 5.0}) {
    Scene scene = bare_scene();
    scene.contacts = {mohr_coulomb(kn, friction)};
    add_body(scene, outline_shape("bar", rectangle(2, 1, segment)), BodyKind::rigid, {0, 0});
    const Points tip = refined({{0, 0}, {0.5, 0.5 * std::sqrt(3)}, {-0.5, 0.5 * std::sqrt(3)}}, segment);
    add_body(scene, outline_shape("tip", tip), BodyKind::rigid, {0, 0});
    ContactRig rig(scene);
    rig.move(1, Vec2(1.001, 0.5 - deep) - rig.node(1, 0));
    rig.step();
    double work = 0, pull = 0;
    const auto go = [&](double depths) {
      const double step = (1 - depths * deep - rig.node(1, 0).x()) / steps;
      for (int i = 0; i < steps; ++i) {
        rig.move(1, {step, 0});
        rig.step();
        work += 0.5 * (rig.force(1).x() + pull) * step;
        pull = rig.force(1).x();
      }
    };
    go(1.3);
    const double stored = rig.totals.stored, dissipated = rig.dissipated;
    work = 0;
    for (int cycle = 0; cycle < 8; ++cycle) go(1.55), go(1.3);
    const double made = rig.totals.stored - stored + rig.dissipated - dissipated + work;
    EXPECT_NEAR(made, 0, 0.01 * stored) << friction;
  }
}

}  // namespace
}  // namespace pliant
