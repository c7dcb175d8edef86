#include <gtest/gtest.h>

#include <cmath>

#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

const ContactRule balance_rules[] = {frictionless(100), mohr_coulomb(100, 0.3, 0.05, 0.2),
                                     cohesive(100, 0.5, 0.05, 0.4)};

// Two bodies in touch, of random outline, the second compliant if asked for, with slip from a small relative motion.
Scene pair_scene(Random& random, const ContactRule& rule, bool compliant) {
  Scene scene = bare_scene();
  scene.contacts = {rule};
  add_random_body(scene, random, random.below(5));
  if (compliant)
    add_body(scene, polygonal_disc("disc", 1.6, 36, 90), BodyKind::compliant, {0, 0}, random.uniform(0, 6));
  else
    add_random_body(scene, random, random.below(5));
  return scene;
}

void deform(ContactRig& rig, Random& random, double size) {
  for (const Batch& batch : rig.model.batches)
    for (int i = 0; i < 2 * rig.model.shape_of(batch).nodes(); ++i)
      for (int lane = 0; lane < batch.count; ++lane)
        rig.q.compliant[batch.offset + i][lane] += random.uniform(-size, size);
}

// Presses together, accepts, shifts along and accepts again: contacts with slip, some at their limit.
void load(ContactRig& rig, Random& random, double slip) {
  press_together(rig, random, 0.04);
  deform(rig, random, 0.004);
  rig.step();
  for (int step = 0; step < 3; ++step) {
    rig.move(0, {random.uniform(-slip, slip), random.uniform(-slip, slip)});
    rig.turn(0, random.uniform(-slip, slip));
    rig.step();
  }
}

struct Balance {
  Vec2 sum{0, 0};
  double moment = 0, magnitude = 0;
};

Balance balance_of(const ContactRig& rig, const Vec2& shift_of_second = {0, 0}) {
  Balance b;
  for (int body = 0; body < 2; ++body)
    for (int k = 0; k < rig.count(body); ++k) {
      const Vec2 f = rig.force(body, k), x = rig.node(body, k) + body * shift_of_second;
      b.sum += f;
      b.moment += cross(x, f);
      b.magnitude += f.norm();
    }
  return b;
}

// EXACT: rounding of a hundred forces, at places of order one; friction acting at the gap's distance included.
void expect_balanced(const Balance& b) {
  EXPECT_LT(b.sum.norm(), 1e-14 * b.magnitude);
  EXPECT_LT(std::abs(b.moment), 2e-14 * b.magnitude);
}

TEST(ContactBalance, ForceAndMoment) {
  int loaded = 0;
  for (int sample = 0; sample < 90; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 300);
    ContactRig rig(pair_scene(random, balance_rules[sample % 3], sample % 2));
    load(rig, random, 0.01);
    const Balance b = balance_of(rig);
    loaded += b.magnitude > 0.1;
    expect_balanced(b);
  }
  EXPECT_GT(loaded, 80);
}

// EXACT: across the period the moment balances about the image in touch.
TEST(ContactBalance, AcrossThePeriod) {
  for (const ContactRule& rule : balance_rules) {
    Scene scene = bare_scene();
    scene.period = 10;
    scene.contacts = {rule};
    for (int i = 0; i < 2; ++i)
      add_body(scene, polygonal_disc("disc", 2, 41), BodyKind::rigid, {1.97 * i + 30 * (1 - i) + 9, 0.1 * i}, i);
    ContactRig rig(scene);
    rig.step();
    rig.move(0, {0.003, 0.02});
    rig.step();
    const Balance b = balance_of(rig, {30, 0});
    EXPECT_GT(b.magnitude, 0.1);
    EXPECT_LT(b.sum.norm(), 1e-14 * b.magnitude);
    EXPECT_LT(std::abs(b.moment), 40 * 2e-14 * b.magnitude);  // levers of 40
  }
}

double energy_at(ContactRig& rig) {
  rig.evaluate();
  return rig.totals.stored;
}

// Minus the derivative of the stored energy by one degree of freedom.
template <class Dof>
double force_by_difference(ContactRig& rig, Dof&& shift, double step) {
  shift(step);
  const double above = energy_at(rig);
  shift(-2 * step);
  const double below = energy_at(rig);
  shift(step);
  return -(above - below) / (2 * step);
}

// Largest difference between the forces and minus the energy gradient over all degrees of freedom, over the largest
// force.
double gradient_defect(ContactRig& rig, double step) {
  rig.evaluate();
  const Dofs force = rig.dof_forces();
  double worst = 0, largest_force = 1e-300;
  const auto compare = [&](double f, auto&& shift) {
    worst = std::max(worst, std::abs(f - force_by_difference(rig, shift, step)));
    largest_force = std::max(largest_force, std::abs(f));
  };
  for (std::size_t r = 0; r < rig.q.rigid.size(); ++r)
    compare(force.rigid[r], [&](double by) { rig.q.rigid[r] += by; });
  for (std::size_t i = 0; i < rig.q.compliant.size(); ++i) {
    if (force.compliant[i][0] == 0) continue;
    compare(force.compliant[i][0], [&](double by) { rig.q.compliant[i][0] += by; });
  }
  return worst / largest_force;
}

// EXACT: the force is minus the gradient of the stored energy. Central differences of step 1e-6: the energy of a record
// is quadratic in positions on a segment of 0.1, so third derivatives are a hundred times the second: 1e-10; rounding
// 1e-16/1e-6 x energy/force: 1e-10.
constexpr double difference_step = 1e-6, difference_error = 1e-7;

TEST(ContactEnergy, NormalForceIsItsGradient) {
  for (int sample = 0; sample < 24; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 500);
    ContactRig rig(pair_scene(random, frictionless(100), sample % 2));
    press_together(rig, random, 0.04);
    deform(rig, random, 0.004);
    EXPECT_LT(gradient_defect(rig, difference_step), difference_error);
  }
}

// The reversible law, normal part only: shear strength 0.
TEST(ContactEnergy, CohesiveForceIsItsGradient) {
  for (int sample = 0; sample < 24; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 600);
    ContactRig rig(pair_scene(random, cohesive(100, 0.5, 0.05, 0), sample % 2));
    press_together(rig, random, sample % 3 ? 0.02 : -0.02);
    deform(rig, random, 0.004);
    EXPECT_LT(gradient_defect(rig, difference_step), difference_error);
  }
}

// After a small slip that stays below the limit: normal and tangential forces together. The last accepted step must be
// this one.
void expect_sticking_gradient(ContactRig& rig, double turn, int contacts = 3) {
  rig.step();
  rig.turn(0, turn);
  rig.move(0, {0.001, -0.001});
  rig.step();
  EXPECT_EQ(rig.dissipated, 0);
  EXPECT_GE(rig.totals.contacts, contacts);
  EXPECT_LT(gradient_defect(rig, difference_step), difference_error);
  EXPECT_EQ(rig.totals.dissipated, 0);
}

TEST(ContactEnergy, StickingForceIsItsGradientUnderPressure) {
  for (int sample = 0; sample < 24; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 700);
    Scene scene = bare_scene();
    scene.contacts = {cohesive(100, 0.01, 0.0002, 100)};
    add_body(scene, polygonal_disc("disc", 2, 60), BodyKind::rigid, {0, 0}, 0.3);
    add_body(scene, polygonal_disc("disc", 1.6, 36, 90), sample % 2 ? BodyKind::compliant : BodyKind::rigid, {0, 0},
             random.uniform(0, 6));
    ContactRig rig(scene);
    press_together(rig, random, 0.02);
    deform(rig, random, 0.01);
    expect_sticking_gradient(rig, 0.004);
  }
}

// Pulled, beside and beyond the ends of faces. The shear strength tapers with the gap, so that nodes as near to the
// range as a share 0.3/1e6 of it would slip: none.
TEST(ContactEnergy, StickingForceIsItsGradientBesideCorners) {
  for (int sample = 0; sample < 48; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 900);
    ContactRig rig(pair_scene(random, cohesive(100, 1.5, 0.04, 1e6), sample % 2));
    press_together(rig, random, -0.01);
    deform(rig, random, 0.002);
    expect_sticking_gradient(rig, 0.002, 1);
  }
}

// Pulled, between flat faces.
TEST(ContactEnergy, StickingForceIsItsGradientUnderTension) {
  for (int sample = 0; sample < 12; ++sample) {
    SCOPED_TRACE(sample);
    Random random(sample + 800);
    Scene scene = bare_scene();
    scene.contacts = {cohesive(100, 1.5, 0.04, 100)};
    add_body(scene, outline_shape("bar", rectangle(3, 0.5, 0.13)), BodyKind::rigid, {0, 0});
    const BodyKind kind = sample % 2 ? BodyKind::compliant : BodyKind::rigid;
    add_body(scene, outline_shape("block", rectangle(1.03, 0.6, 0.12), 80), kind,
             {random.uniform(-0.5, 0.5), 0.55 + random.uniform(0.003, 0.03)});
    ContactRig rig(scene);
    deform(rig, random, 0.002);
    expect_sticking_gradient(rig, 0.002);
  }
}

}  // namespace
}  // namespace pliant
