// The stability bound against the true largest eigenvalue of M^-1 K, from dense finite differences (docs/method.md 6).
#include "dynamics/time_step_bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "bodies/place_outlines.hpp"
#include "dynamics/true_spectrum.hpp"
#include "dynamics/verlet.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

/// w^2 that a bound stands for when safety is 1: dt = 2/w.
double square_frequency(const TimeStepBound& bound, const Scene& scene) {
  const double dt = bound.largest_dt() / scene.time.safety;
  return 4 / (dt * dt);
}

double bound_of(Bench& bench) {
  TimeStepBound bound(bench.model, bench.forces.contact().laws());
  bound.update_internal(bench.state.position, bench.state.memory);
  bound.update_contact(bench.forces.contact(), bench.forces.bonds());
  return square_frequency(bound, bench.model.scene);
}

class InternalBound : public ::testing::TestWithParam<std::pair<int, Eigen::Matrix2d>> {};

/// The margin of 1.05 must cover what 60 power iterations miss, and the estimate itself never exceeds the largest
/// eigenvalue.
TEST_P(InternalBound, lies_within_its_margin_above_the_true_eigenvalue) {
  const auto& [nodes, F] = GetParam();
  Bench bench(free_disc(nodes, 1));
  bench.deform(F);
  const double truth = largest_square_frequency(bench), bound = bound_of(bench);
  EXPECT_GE(bound, truth) << "INDEPENDENT: dense eigenvalues; a smaller bound is unstable at safety 1";
  EXPECT_LE(bound, 1.05 * truth * (1 + 1e-4))
      << "INDEPENDENT: a Rayleigh quotient is at most w^2; 1e-4: finite differences";
}

INSTANTIATE_TEST_SUITE_P(Discs, InternalBound,
                         ::testing::Values(std::pair(40, matrix(1, 0, 0, 1)), std::pair(100, matrix(1, 0, 0, 1)),
                                           std::pair(60, matrix(0.6, 0, 0, 1.2)),
                                           std::pair(60, matrix(1.2, 0.3, -0.1, 0.85))));

// EXACT: a body that turns between updates has the same spectrum, and two more iterations on the same vector, turned
// along, only come closer to it; on one left behind they do not, and an undamped disc that spins blows up. Finite
// differences over 1e-6 round to 1e-9.
TEST(InternalBounds, follow_a_body_that_turns) {
  Bench bench(free_disc(60, 1));
  bench.deform(matrix(1.1, 0.2, 0, 0.9));
  TimeStepBound bound(bench.model, bench.forces.contact().laws());
  bound.update_internal(bench.state.position, bench.state.memory);
  double last = bound.largest_dt();
  for (int turn = 1; turn <= 20; ++turn) {
    bench.deform(Eigen::Rotation2Dd(0.4).toRotationMatrix());
    bound.update_internal(bench.state.position, bench.state.memory);
    EXPECT_LE(bound.largest_dt(), last * (1 + 1e-8)) << turn;
    last = bound.largest_dt();
  }
}

/// Bodies already in touch: the bound covers the spectrum of internal and contact forces together.
Scene two_compliant_discs(const ContactRule& contact) {
  Scene scene = free_disc(40, 1);
  scene.grains[0].packing.positions = {{0, 0}, {1.93, 0.3}};
  scene.contacts = {contact};
  return scene;
}

Scene disc_on_wall(BodyKind kind, const ContactRule& contact) {
  Scene scene = free_disc(40, 1);
  scene.period = 4;
  scene.grains[0].species[0] = {kind, kind == BodyKind::rigid ? "hard" : "soft", 1};
  scene.grains[0].packing.positions = {{2, 0}};
  scene.walls = {flat_wall("floor", Wall::Solid::below, -0.97, 0.25)};
  scene.contacts = {contact};
  return scene;
}

/// A compliant disc between a rigid one and a pressed wall.
Scene mixed_column(const ContactRule& contact) {
  Scene scene = free_disc(40, 1);
  scene.period = 4;
  scene.grains = {grains("soft", "disc", BodyKind::compliant, {{2, 1.95}}),
                  grains("hard", "disc", BodyKind::rigid, {{2, 0}})};
  scene.walls = {flat_wall("floor", Wall::Solid::below, -0.98, 0.25),
                 flat_wall("lid", Wall::Solid::above, 2.93, 0.25, 0.5)};
  scene.walls[1].x.mode = scene.walls[1].y.mode = AxisCondition::Mode::pressure;
  scene.walls[1].x.history = scene.walls[1].y.history = constant(0);
  scene.contacts = {contact};
  return scene;
}

/// A rigid block that others enclose, out of line so that no corners meet: neighbours that move against it double
/// what each feels alone.
Scene enclosed_block(const ContactRule& contact) {
  Scene scene = empty_scene(1);
  scene.shapes = {box_shape("block", 1, 1, 0.1)};
  scene.grains = {grains("blocks", "block", BodyKind::rigid,
                         {{0, 0}, {0.99, 0.037}, {-0.99, -0.037}, {-0.037, 0.99}, {0.037, -0.99}})};
  scene.contacts = {contact};
  return scene;
}

std::vector<Scene> touching_scenes(const ContactRule& contact) {
  return {two_compliant_discs(contact), disc_on_wall(BodyKind::compliant, contact),
          disc_on_wall(BodyKind::rigid, contact), mixed_column(contact), enclosed_block(contact)};
}

int contacts_of(Bench& bench) {
  Trial trial(bench.model);
  return bench.evaluate(trial).contact.contacts;
}

class ContactBound : public ::testing::TestWithParam<double> {};

/// Sticking contacts: shear of the same stiffness acts as well. Corrected mass makes what is light lighter, scaled mass
/// makes it heavier.
TEST_P(ContactBound, covers_contacts_of_every_kind_of_body) {
  for (const auto& [contact, mass, scaling] : {std::tuple(frictionless(GetParam()), Mass::lumped, 1.0),
                                               {mohr_coulomb(GetParam(), 100), Mass::corrected, 1.0},
                                               {frictionless(GetParam()), Mass::lumped, 3.0},
                                               {mohr_coulomb(GetParam(), 100), Mass::lumped, 10.0}})
    for (Scene scene : touching_scenes(contact)) {
      scene.discretisation.mass = mass, scene.discretisation.mass_scaling = scaling;
      Bench bench(scene);
      ASSERT_GT(contacts_of(bench), 0);
      EXPECT_GE(bound_of(bench), largest_square_frequency(bench, 1e-7)) << "INDEPENDENT: dense eigenvalues";
    }
}

/// Direction of the lightest node on the outline of the scene's first shape, for methods that interpolate.
double lightest_direction(const Scene& scene) {
  const Model model = build_model(scene);
  const CompliantShape& shape = model.shape_of(model.bodies[0]);
  const auto inverse_mass = [&](int k) {
    return shape.inverse_mass_at_unit_density[shape.space.outline_rows.node[shape.space.outline_rows.start[k]]];
  };
  int lightest = 0;
  for (int k = 1; k < model.outlines[0].count; ++k)
    if (inverse_mass(k) > inverse_mass(lightest)) lightest = k;
  const Vec2& point = model.outlines[0].points[lightest];
  return std::atan2(point.y(), point.x());
}

/// Two equal discs, their lightest nodes face to face: a pair of one mass on one spring. Twice the stiffness over the
/// mass is then the very w^2 of contact, and the bound has least to give away.
TEST(TimeStepBound, covers_light_nodes_face_to_face) {
  for (const auto& [contact, mass, scaling] : {std::tuple(frictionless(3000), Mass::lumped, 1.0),
                                               {mohr_coulomb(3000, 100), Mass::lumped, 1.0},
                                               {frictionless(3000), Mass::corrected, 1.0},
                                               {mohr_coulomb(3000, 100), Mass::corrected, 1.0},
                                               {frictionless(3000), Mass::lumped, 3.0}}) {
    Scene scene = free_disc(40, 1);
    scene.discretisation.method = DiscretisationMethod::es_t3;
    scene.discretisation.mass = mass, scene.discretisation.mass_scaling = scaling;
    scene.grains.push_back(grains("other", "disc", BodyKind::compliant, {{1.99, 0}}));
    scene.grains[0].angle = -lightest_direction(scene);
    scene.grains[1].angle = *scene.grains[0].angle + M_PI;
    scene.contacts = {contact};
    Bench bench(scene);
    ASSERT_GT(contacts_of(bench), 0);
    const double truth = largest_square_frequency(bench, 1e-7), bound = bound_of(bench);
    EXPECT_GE(bound, truth) << "INDEPENDENT: dense eigenvalues";
    EXPECT_LE(bound, (mass == Mass::lumped && scaling == 1 ? 1.1 : 1.3) * truth)
        << "FROZEN: 1.07 and, with friction, 1.03 when written; corrected mass: 1.24 and 1.20; scaled: 1.20";
  }
}

/// The corner of a rigid polygon, far coarser than a disc's outline, presses on it, `x` beside its topmost node.
Scene corner_on_fine_outline(double x, int outline_nodes) {
  Scene scene = free_disc(150, 1);
  scene.discretisation.method = DiscretisationMethod::t3;
  scene.shapes[0].outline_nodes = outline_nodes;
  scene.shapes.push_back(polygonal_disc("polygon", 6, 12));
  scene.contacts = {frictionless(6000)};
  const auto radius = [](double of_circle, int sides) {
    return of_circle * std::sqrt(2 * M_PI / sides / std::sin(2 * M_PI / sides));
  };
  const double top = radius(1, outline_nodes), depth = 0.003;
  scene.grains.push_back(grains("polygon", "polygon", BodyKind::rigid, {{x, top + radius(3, 12) - depth}}));
  return scene;
}

/// Until the next search for candidates it may slide by a skin, from between two nodes onto one, which then bears alone
/// what both did.
TEST(TimeStepBound, holds_where_a_coarse_node_slides_onto_a_fine_one) {
  constexpr int outline_nodes = 90, places = 9;
  const double spacing = 2 * std::sin(M_PI / outline_nodes);
  double x[places], truth[places], bound[places], skin = 0;
  for (int i = 0; i < places; ++i) {
    x[i] = spacing * (i / (places - 1.0) - 0.5);
    Bench bench(corner_on_fine_outline(x[i], outline_nodes));
    ASSERT_GT(contacts_of(bench), 0);
    truth[i] = largest_square_frequency(bench, 1e-7), bound[i] = bound_of(bench);
    skin = bench.forces.contact().skin();
  }
  EXPECT_GT(*std::max_element(truth, truth + places), 1.7 * *std::min_element(truth, truth + places))
      << "EXACT: 2 for nodes of one mass, but for the disc's own stiffness; or there is nothing to see";
  for (int i = 0; i < places; ++i)
    for (int j = 0; j < places; ++j)
      if (std::abs(x[i] - x[j]) < skin) {
        EXPECT_GE(bound[i], truth[j]) << "INDEPENDENT: dense eigenvalues; from " << x[i] << " to " << x[j];
      }
}

/// The bound gives away a factor of at most 2 in w^2 for two compliant bodies and about 2 for absolute values and the
/// skin: a time step halved by it, not less, where compliant bodies govern.
TEST_P(ContactBound, is_of_use) {
  const ContactRule contact = frictionless(GetParam());
  for (const Scene& scene :
       {two_compliant_discs(contact), disc_on_wall(BodyKind::compliant, contact), mixed_column(contact)}) {
    Bench bench(scene);
    EXPECT_LE(bound_of(bench), 4 * largest_square_frequency(bench, 1e-7)) << "FROZEN: 3.5 when written";
  }
}

/// A trial that is rejected may have found new neighbours, which lower the bound: the retry keeps to it.
TEST(TimeStepBound, holds_for_the_retry_after_a_refresh) {
  const auto retry = [](double tolerance, const auto& look) {
    Scene scene = enclosed_block(frictionless(100));
    scene.grains[0].packing.positions[0] = {0, 9};  // far from the others, until moved
    scene.time.tolerance = tolerance;
    scene.time.safety = 0.8;
    Bench bench(scene);
    Verlet verlet(bench.forces, bench.state);
    bench.state.position.rigid[1] = 0;
    bench.state.outlines.position = placed_outlines(bench.model, bench.state.position);
    bench.control.next_dt = 1;
    const double before = verlet.bound().largest_dt();
    const StepReport report = take_step(verlet, bench.forces, bench.state, bench.control, 1e9);
    look(report, before, verlet.bound().largest_dt());
  };
  double error = 0;
  retry(1e300, [&](const StepReport& report, double before, double after) {
    error = report.error;
    EXPECT_NEAR(report.dt, before, 1e-6 * before) << "EXACT: accepted at once";
    EXPECT_LT(after, 0.75 * before) << "EXACT: neighbours all around double w^2 at least";
  });
  // Just over twice the tolerance: the controller alone would retry with 0.78 of the step.
  retry(error / 2.1, [&](const StepReport& report, double, double after) {
    EXPECT_EQ(report.rejections, 1) << "EXACT";
    EXPECT_LE(report.dt, after) << "EXACT";
  });
}

INSTANTIATE_TEST_SUITE_P(Stiffnesses, ContactBound, ::testing::Values(10.0, 100.0, 3000.0));

/// Two squares with cement in the gap between them.
Scene cemented(BodyKind kind, double gap) {
  Scene scene = empty_scene(1);
  scene.shapes = {box_shape("square", 1, 1, 0.25)};
  scene.grains = {grains("left", "square", kind, {{-0.5, 0}}), grains("right", "square", kind, {{0.5 + gap, 0}})};
  scene.contacts = {frictionless(100)};
  BondRule rule;
  rule.first = rule.second = "all";
  rule.gap = 1.01 * gap;
  rule.stiffness = 1000, rule.strength = 1e6, rule.fracture_energy = 1e12;
  scene.bonds = {rule};
  return scene;
}

// INDEPENDENT: dense eigenvalues. The frame of a bond turns with its ends, and moves them the more the wider the gap.
TEST(TimeStepBound, covers_cement_in_a_gap) {
  for (const BodyKind kind : {BodyKind::compliant, BodyKind::rigid})
    for (const double gap : {0.05, 0.25, 1.0, 4.0}) {
      Bench bench(cemented(kind, gap));
      ASSERT_FALSE(bench.forces.bonds().is_empty());
      const double truth = largest_square_frequency(bench, 1e-7), bound = bound_of(bench);
      EXPECT_GE(bound, truth) << gap;
      EXPECT_LE(bound, 25 * truth) << "FROZEN: 22 with a gap of 16 segments when written; gap " << gap;
    }
}

// EXACT: cement that is torn exerts no force, however far apart its ends are: the bound is that without any.
TEST(TimeStepBound, forgets_torn_cement) {
  Scene scene = cemented(BodyKind::rigid, 0.25);
  Bench bench(scene);
  scene.bonds.clear();
  Bench without(scene);
  EXPECT_GT(bound_of(bench), 10 * bound_of(without));
  for (auto& ends : bench.state.memory.bonds.ends)
    for (BondEnd& end : ends) end.damage = broadcast(1);
  for (Bench* one : {&bench, &without}) {
    one->state.position.rigid[0] -= 10;
    one->evaluate_here();  // far enough for another search
  }
  EXPECT_EQ(bound_of(bench), bound_of(without));
}

/// A bar that dead loads pull at both ends: it swings about them as a needle does.
Scene needle() {
  Scene scene = empty_scene(1);
  scene.shapes = {box_shape("bar", 2, 0.4, 0.2)};
  scene.grains = {grains("bar", "bar", BodyKind::rigid, {{0.3, 0.1}})};
  for (const double side : {-1.0, 1.0}) {
    BoundaryCondition pull;
    pull.kind = BoundaryCondition::Kind::pressure;
    pull.grains = "bar";
    pull.part = {.kind = OutlinePart::Kind::side, .side = {side, 0}};
    pull.pressure = constant(-3);
    pull.following = false;
    scene.boundary.push_back(pull);
  }
  return scene;
}

// EXACT: w^2 = 2 F R/I with F = 3 x 0.4, R = 1, I = m (2^2 + 0.4^2)/12.
TEST(TimeStepBound, covers_dead_loads_on_a_rigid_body) {
  Bench bench(needle());
  const double exact = 2 * 3 * 0.4 / (2 * 0.4 * (4 + 0.16) / 12);
  EXPECT_NEAR(largest_square_frequency(bench, 1e-4), exact, 1e-6 * exact) << "finite differences";
  EXPECT_NEAR(bound_of(bench), exact, 1e-12 * exact);
}

}  // namespace
}  // namespace pliant::dynamics_tests
