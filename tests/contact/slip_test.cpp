#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

/// Contact sees steps, and forces without energy correction.
Scene scene_of_steps() {
  Scene scene = nodal_scene();
  scene.contact.energy_consistent = false;
  return scene;
}

// A block of 1.01 x 0.5 on a long bar, nodes every 0.1. The bar's nodes beside the block's corners are 0.055 inside and
// 0.045 outside: within +-0.018 none comes near another face.
Scene sliding_block_on_bar(const ContactRule& rule) {
  Scene scene = scene_of_steps();
  scene.contacts = {rule};
  add_body(scene, outline_shape("bar", rectangle(4, 1, 0.1)), BodyKind::rigid, {0, -0.5});
  add_body(scene, outline_shape("block", rectangle(1.01, 0.5, 0.1)), BodyKind::rigid, {0.05, 0.25});
  return scene;
}

using Path = std::function<Vec2(double)>;

double largest_slip(const ContactRig& rig) {
  double largest = 0;
  for (int i = 0; i < rig.committed.records(); ++i)
    largest = std::max(largest, std::abs(rig.committed.number(i, ContactHistory::slip)));
  return largest;
}

struct WorkBalance {
  double work = 0, stored_change = 0, dissipated = 0;
  double defect() const { return stored_change + dissipated + work; }
};

// Moves the block along a path from s = 0 to 1 in equal steps, each accepted; work of the contact forces by the
// trapezoidal rule.
WorkBalance follow(ContactRig& rig, const Path& path, int steps) {
  const Vec2 start(rig.rigid(1)[0], rig.rigid(1)[1]);
  const auto go = [&](double s) {
    const Vec2 at = start + path(s);
    rig.rigid(1)[0] = at.x(), rig.rigid(1)[1] = at.y();
    rig.step();
    return rig.force(1);
  };
  WorkBalance balance;
  Vec2 force = go(0);
  rig.dissipated = 0;
  const double stored = rig.totals.stored;
  for (int step = 1; step <= steps; ++step) {
    const Vec2 next = go(static_cast<double>(step) / steps);
    balance.work += 0.5 * (force + next).dot(path(static_cast<double>(step) / steps) - path((step - 1.0) / steps));
    force = next;
  }
  balance.stored_change = rig.totals.stored - stored;
  balance.dissipated = rig.dissipated;
  return balance;
}

Vec2 back_and_forth(double s) { return {0.018 * std::sin(2 * M_PI * s), -0.02 - 0.01 * std::sin(4 * M_PI * s)}; }

// EXACT: on flat faces slip is the motion itself and every law linear in it, so the trapezoidal rule is exact in each
// step, also where slip starts or turns: what the surfaces take in, stored and dissipated, is what the block's forces
// do. Rounding of 200 steps.
TEST(ContactSlip, WorkIsStoredOrDissipated) {
  for (const ContactRule& rule : {mohr_coulomb(100, 0.3), mohr_coulomb(100, 0.2, 0.3), cohesive(100, 0.5, 0.02, 0.6)}) {
    ContactRig rig(sliding_block_on_bar(rule));
    const WorkBalance balance = follow(rig, back_and_forth, 200);
    EXPECT_GT(balance.dissipated, 0.005);
    EXPECT_LT(std::abs(balance.defect()), 1e-13);
  }
}

// EXACT: while everything sticks, a closed path dissipates nothing and gives the work back.
TEST(ContactSlip, StickingGivesTheWorkBack) {
  ContactRig rig(sliding_block_on_bar(mohr_coulomb(100, 0.3, 10)));
  const WorkBalance balance = follow(rig, back_and_forth, 100);
  EXPECT_EQ(balance.dissipated, 0);
  EXPECT_LT(std::abs(balance.work), 1e-13);
}

// EXACT: the area of the Coulomb hysteresis loop. Amplitude A, normal force N, limit reached 2 u_c after each turn, u_c
// = mu p/kt: a closed cycle from a state of full slip dissipates mu N (4 A - 4 u_c). Steps of 0.002 end where slip
// starts, 0.012 after a turn.
TEST(ContactSlip, HysteresisLoop) {
  constexpr double depth = 0.02, friction = 0.3, amplitude = 0.018;
  ContactRig rig(sliding_block_on_bar(mohr_coulomb(100, friction)));
  const Path swing = [](double s) { return Vec2(amplitude * (std::abs(4 * s - 2) - 1), -depth); };
  follow(rig, swing, 36);
  rig.rigid(1)[0] = 0.05, rig.rigid(1)[1] = 0.25;
  const WorkBalance balance = follow(rig, swing, 36);
  const double normal = rig.force(1).y();
  EXPECT_NEAR(balance.dissipated, friction * normal * 4 * (amplitude - friction * depth), 1e-13);
  EXPECT_NEAR(balance.stored_change, 0, 1e-14);
}

// RATE: a tip inside one segment of a turning bar, far from its corners, slipping to and fro: forces change direction
// along the way, and the trapezoidal rule errs by O(steps^-2). Kinks where slip turns make single ratios uneven: order
// over a factor of 8, 2 +- 0.25.
double turning_defect(const ContactRule& rule, int steps) {
  Scene scene = scene_of_steps();
  scene.contacts = {rule};
  add_body(scene, outline_shape("bar", rectangle(4, 1, 0.5)), BodyKind::rigid, {0, 0});
  add_body(scene, outline_shape("tip", {{0, 0}, {0.4, 0.5}, {-0.4, 0.5}}), BodyKind::rigid, {0, 0});
  ContactRig rig(scene);
  const auto place = [&](double s) {
    const double angle = 0.6 * s, c = std::cos(angle), n = std::sin(angle);
    const Vec2 on_bar(0.25 + 0.08 * std::sin(5 * s), 0.5 - 0.02 - 0.01 * std::cos(3 * s));
    const Vec2 centroid = on_bar + Vec2(0, 1.0 / 3);  // the tip lies a third below it
    rig.rigid(0)[2] = rig.rigid(1)[2] = angle;        // together: the tip's length of contact depends on how it stands
    rig.rigid(1)[0] = c * centroid.x() - n * centroid.y();
    rig.rigid(1)[1] = n * centroid.x() + c * centroid.y();
    rig.step();
    return rig.dof_forces().rigid;
  };
  std::vector<double> force = place(0), at = rig.q.rigid;
  rig.dissipated = 0;
  double work = 0;
  const double stored = rig.totals.stored;
  for (int step = 1; step <= steps; ++step) {
    const std::vector<double> next = place(static_cast<double>(step) / steps);
    for (std::size_t d = 0; d < at.size(); ++d) work += 0.5 * (force[d] + next[d]) * (rig.q.rigid[d] - at[d]);
    force = next, at = rig.q.rigid;
  }
  EXPECT_EQ(rig.totals.contacts, 1);
  return std::abs(rig.totals.stored - stored + rig.dissipated + work);
}

TEST(ContactSlip, WorkOnATurningSurfaceConverges) {
  for (const ContactRule& rule :
       {mohr_coulomb(100, 0.3), mohr_coulomb(100, 0.3, 1000), cohesive(100, 0.5, 0.02, 0.6)}) {
    const double coarse = turning_defect(rule, 100), middle = turning_defect(rule, 200),
                 fine = turning_defect(rule, 800);
    EXPECT_GT(coarse, 1e-9);
    EXPECT_LT(middle, coarse);
    EXPECT_NEAR(std::log2(coarse / fine) / 3, 2, 0.25) << coarse << " " << middle << " " << fine;
  }
}

/// Work that a closed path of a tip on a bar creates. Meanwhile the bar stretches along its axis and back, in phase
/// with the tip.
double stretching_defect(const ContactRule& rule, int steps) {
  Scene scene = scene_of_steps();
  scene.contacts = {rule};
  ShapeSpec bar = outline_shape("bar", rectangle(4, 1, 0.5));
  bar.spacing = 0.5;
  add_body(scene, bar, BodyKind::compliant, {0, 0});
  add_body(scene, outline_shape("tip", {{0, 0}, {0.4, 0.5}, {-0.4, 0.5}}), BodyKind::rigid, {0, 0});
  ContactRig rig(scene);
  const Dofs start = rig.q;
  const auto place = [&](double s) {
    const double swing = std::sin(2 * M_PI * s), turn = 1 - std::cos(2 * M_PI * s);
    for (std::size_t i = 0; i < start.compliant.size(); i += 2)
      rig.q.compliant[i] = (1 + 0.1 * swing) * start.compliant[i];
    rig.rigid(1)[0] = 0.25 + 0.08 * swing + 0.01 * turn, rig.rigid(1)[1] = 0.5 - 0.02 + 1.0 / 3 - 0.002 * swing;
    rig.step();
  };
  place(0);
  rig.dissipated = 0;
  const double stored = rig.totals.stored;
  double work = 0;
  for (int step = 1; step <= steps; ++step) {
    const OutlineField before = rig.outlines.position, force = rig.forces;
    place(static_cast<double>(step) / steps);
    for (std::size_t i = 0; i < before.x.size(); ++i)
      work += 0.5 * ((force.x[i] + rig.forces.x[i]) * (rig.outlines.position.x[i] - before.x[i]) +
                     (force.y[i] + rig.forces.y[i]) * (rig.outlines.position.y[i] - before.y[i]));
  }
  EXPECT_GT(rig.totals.contacts, 0);
  return rig.totals.stored - stored + rig.dissipated + work;
}

// RATE: second order in the step also where the master stretches. With the length at the end of each step the slip of
// a surface that vibrates would create energy of first order.
TEST(ContactSlip, WorkOnAStretchingSurfaceConverges) {
  for (const ContactRule& rule : {mohr_coulomb(100, 0.3, 1000), cohesive(100, 0.5, 0.02, 0.6)}) {
    const double coarse = std::abs(stretching_defect(rule, 100)), fine = std::abs(stretching_defect(rule, 800));
    EXPECT_GT(coarse, 1e-9);
    EXPECT_NEAR(std::log2(coarse / fine) / 3, 2, 0.25) << coarse << " " << fine;
  }
}

// EXACT: steps there and back, past corners, cancel: a slip increment is odd in the exchange of its ends.
TEST(ContactSlip, IncrementsThereAndBackCancel) {
  Scene scene = scene_of_steps();
  scene.contacts = {mohr_coulomb(100, 0.3, 1000)};
  add_body(scene, polygonal_disc("wheel", 1, 24, 60), BodyKind::compliant, {0, 0});
  add_body(scene, outline_shape("needle", {{0, 0}, {3, 4}, {-3, 4}}), BodyKind::rigid, {0, 0});
  ContactRig rig(scene);
  const Dofs start = rig.q;
  const auto place = [&](double angle, double stretch, double depth) {  // changes lengths and turns of corners
    for (std::size_t i = 0; i < start.compliant.size(); i += 2) rig.q.compliant[i] = stretch * start.compliant[i];
    const Vec2 out(std::sin(angle), std::cos(angle));
    const Vec2 centroid = (0.5 - depth + 8.0 / 3) * out;
    rig.rigid(1)[0] = centroid.x(), rig.rigid(1)[1] = centroid.y(), rig.rigid(1)[2] = -angle;
    rig.step();
  };
  place(0.05, 1, 0.02);
  const double first = largest_slip(rig);
  EXPECT_EQ(first, 0);
  place(0.4, 1.02, 0.03);
  EXPECT_GT(largest_slip(rig), 0.1);
  place(0.05, 1, 0.02);
  EXPECT_LT(largest_slip(rig), 1e-14);
}

// EXACT: a node at rest gets no slip, also beside a vertex, whose surface coordinate is rounded.
TEST(ContactSlip, RestBesideAVertexGivesNone) {
  for (int sample = 0; sample < 100; ++sample) {
    Scene scene = scene_of_steps();
    scene.contacts = {cohesive(100, 5, 0.08, 1e6)};
    add_body(scene, outline_shape("polygon", regular(100, 1)), BodyKind::rigid, {0, 0});
    add_body(scene, outline_shape("needle", {{0, 0}, {3, 4}, {-3, 4}}), BodyKind::rigid, {0, 0});
    ContactRig rig(scene);
    const double angle = 2 * M_PI * sample / 100 + 0.002 * std::sin(sample);  // a corner's, 0.06 outside
    rig.rigid(1)[2] = angle - M_PI / 2;
    const Vec2 centroid = (1.06 + 8.0 / 3) * Vec2(std::cos(angle), std::sin(angle));
    rig.rigid(1)[0] = centroid.x(), rig.rigid(1)[1] = centroid.y();
    for (int step = 0; step < 3; ++step) rig.step();
    EXPECT_GE(rig.totals.contacts, 1);
    EXPECT_EQ(largest_slip(rig), 0);
  }
}

// A disc slid over a bar, past many corners: nodes inside a convex outline travel less than the outline is long, and
// what is accounted for as dissipated is what is done as work. EXACT up to the finite steps in which corners are
// passed, where the normal turns: these err by chance to either side. Counting the outline's own length would count
// 0.45 of depth/R too much, 15 times the limit.
TEST(ContactSlip, WorkPastConvexCorners) {
  for (const double depth : {0.005, 0.02}) {
    Scene scene = scene_of_steps();
    scene.contacts = {mohr_coulomb(100, 0.3)};
    add_body(scene, outline_shape("bar", rectangle(4, 1, 0.1)), BodyKind::rigid, {0, -0.5});
    add_body(scene, polygonal_disc("disc", 2, 48), BodyKind::rigid, {-0.5, 1 - depth}, 0.1);
    ContactRig rig(scene);
    const WorkBalance balance = follow(rig, [](double s) { return Vec2(s, 0); }, 8000);
    EXPECT_GT(balance.dissipated, 0.02);
    EXPECT_LT(std::abs(balance.defect()), 0.03 * depth * balance.dissipated);
  }
}

// EXACT: the way around an outline. A node that circles a regular polygon of n sides at a gap g outside goes n l along
// faces and 2 pi g around corners; below the faces it goes n (l - 2 |g| tan(pi/n)).
TEST(ContactSlip, WayAroundAPolygon) {
  constexpr int n = 12;
  const double l = 2 * std::sin(M_PI / n), apothem = std::cos(M_PI / n);
  for (const double gap : {0.03, -0.03}) {
    Scene scene = scene_of_steps();
    scene.contacts = {cohesive(100, 5, 0.08, 1e6)};
    add_body(scene, outline_shape("polygon", regular(n, 1)), BodyKind::rigid, {0, 0});
    // A needle whose tip is the only node that ever comes near.
    add_body(scene, outline_shape("needle", {{0, 0}, {3, 4}, {-3, 4}}), BodyKind::rigid, {0, 0});
    ContactRig rig(scene);
    constexpr int steps = 1200;
    double slip = 0;
    for (int step = 0; step <= steps; ++step) {
      const double angle = 2 * M_PI * (step + 0.5) / steps, within = std::remainder(angle - M_PI / n, 2 * M_PI / n);
      // Polar radius of the curve at the gap: parallel to a face, or round a corner.
      const double face = (apothem + gap) / std::cos(within),
                   beyond = std::abs((apothem + gap) * std::tan(within)) - l / 2;
      double radius = face;
      if (gap > 0 && beyond > 0) {
        const double off = M_PI / n - std::abs(within);
        radius = std::cos(off) + std::sqrt(gap * gap - std::sin(off) * std::sin(off));
      }
      const Vec2 tip = radius * Vec2(std::cos(angle), std::sin(angle));
      rig.rigid(1)[2] = angle - M_PI / 2;
      const Vec2 down = 8.0 / 3 * Vec2(std::cos(angle), std::sin(angle));
      rig.rigid(1)[0] = tip.x() + down.x(), rig.rigid(1)[1] = tip.y() + down.y();
      rig.step();
      EXPECT_GE(rig.totals.contacts, 1);
      slip = largest_slip(rig);
    }
    const double expected = gap > 0 ? n * l + 2 * M_PI * gap : n * (l - 2 * 0.03 * std::tan(M_PI / n));
    // Steps turn the normal by up to 10 degrees within a corner, and count sines: 2 pi g (pi/18)^2/6.
    EXPECT_NEAR(slip, expected, gap > 0 ? 1e-3 : 1e-12);
  }
}

// EXACT: a bond torn open under shear sets its tangential energy free: all of it is dissipated, none lost.
TEST(ContactSlip, OpeningDissipatesTheTangentialEnergy) {
  for (const ContactRule& rule : {mohr_coulomb(100, 0.3, 5), cohesive(100, 0.5, 0.02, 5)}) {
    ContactRig rig(sliding_block_on_bar(rule));
    follow(rig, [](double s) { return Vec2(0.015 * s, -0.01); }, 10);
    EXPECT_EQ(rig.dissipated, 0);
    const double shear = rig.force(1).x(), tangential = 0.5 * std::abs(shear) * 0.015;
    rig.dissipated = 0;
    rig.move(1, {0, 0.035});  // to a gap of 0.025, beyond the laws' reach
    rig.step();
    EXPECT_EQ(rig.totals.contacts, 0);
    EXPECT_EQ(rig.totals.stored, 0);
    EXPECT_NEAR(rig.dissipated, tangential, 1e-13);
    rig.step();
    EXPECT_EQ(rig.totals.dissipated, 0);
  }
}

// EXACT: surfaces that meet again start without slip.
TEST(ContactSlip, NewContactStartsWithoutSlip) {
  ContactRig rig(sliding_block_on_bar(mohr_coulomb(100, 0.3)));
  follow(rig, [](double s) { return Vec2(0.015 * s, -0.02); }, 10);
  EXPECT_LT(rig.force(1).x(), -0.1);
  rig.move(1, {0, 0.1});
  rig.step();
  rig.move(1, {0, -0.1});
  rig.step();
  EXPECT_NEAR(rig.force(1).x(), 0, 1e-15);
}

// EXACT: evaluations that are not accepted leave no trace.
TEST(ContactSlip, RejectedTrialsLeaveNoTrace) {
  ContactRig rig(sliding_block_on_bar(mohr_coulomb(100, 0.3)));
  follow(rig, [](double s) { return Vec2(0.005 * s, -0.02); }, 5);
  rig.evaluate();
  const Vec2 before = rig.force(1);
  for (const double x : {0.01, -0.015, 0.008}) {
    rig.move(1, {x, 0.004});
    rig.evaluate();
    EXPECT_GT((rig.force(1) - before).norm(), 1e-3);
    rig.move(1, {-x, -0.004});
  }
  rig.evaluate();
  EXPECT_LT((rig.force(1) - before).norm(), 1e-13);
  EXPECT_NEAR(rig.totals.dissipated, 0, 1e-15);
}

}  // namespace
}  // namespace pliant
