#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <type_traits>

#include "core/archive.hpp"
#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr double floor_friction = 0.3, depth_in_floor = 0.02;

// A block of 1.03 x 0.5 on a floor of period 4, nodes every 0.1 on both.
Scene block_on_floor(double x, const ContactRule& rule = mohr_coulomb(100, floor_friction)) {
  Scene scene = nodal_scene();
  scene.period = 4;
  scene.contacts = {rule};
  add_body(scene, outline_shape("block", rectangle(1.03, 0.5, 0.1)), BodyKind::rigid, {x, 0.25 - depth_in_floor});
  scene.walls = {free_wall("floor", Wall::Solid::below, 0, 0.1)};
  return scene;
}

// EXACT: three periods of sliding over 120 segments. Wherever no floor node is just at a corner of the block, all
// records are at the limit: the force's ratio is the friction, with no dent where nodes pass from segment to segment or
// across the period.
void expect_steady_sliding(double direction, int moved_body) {
  ContactRig rig(block_on_floor(0.035));
  rig.step();
  int sampled = 0;
  for (int step = 1; step <= 2400; ++step) {
    rig.move(moved_body, {direction * 0.005, 0});
    rig.step();
    // Corners lie 0.015 before and after the floor's nodes; a node that came in has slipped to its limit after friction
    // x depth = 0.006.
    if (step < 20 || step % 20 != 0) continue;
    ++sampled;
    const Vec2 f = rig.force(0);
    const double sign = moved_body == 0 ? -direction : direction;
    EXPECT_NEAR(f.x() / f.y(), sign * floor_friction, 1e-12) << "step " << step;
    EXPECT_NEAR(f.y(), 100 * depth_in_floor * 1.0, 0.15) << "step " << step;
  }
  EXPECT_EQ(sampled, 120);
}

TEST(ContactHistory, BlockSlidesRight) { expect_steady_sliding(1, 0); }
TEST(ContactHistory, BlockSlidesLeft) { expect_steady_sliding(-1, 0); }
TEST(ContactHistory, FloorSlidesUnderTheBlock) { expect_steady_sliding(1, 1); }

// EXACT: two discs that stick with some slip keep their forces while they travel many periods together, in steps that
// never repeat a phase.
TEST(ContactHistory, TravelsWithTheBodies) {
  Scene scene = nodal_scene();
  scene.period = 5;
  scene.contacts = {cohesive(100, 0.5, 0.02, 1)};
  for (int i = 0; i < 2; ++i) add_body(scene, polygonal_disc("disc", 2, 41), BodyKind::rigid, {1.97 * i, 0.2 * i}, i);
  ContactRig rig(scene);
  rig.step();
  rig.move(0, {0, 0.004});
  rig.step();
  const Vec2 force = rig.force(0);
  const double stored = rig.totals.stored;
  for (int step = 0; step < 40; ++step) {
    for (int body = 0; body < 2; ++body) rig.move(body, {step < 20 ? 1.73 : -3.19, 0});
    rig.step();
    // Coordinates of up to 35 carry errors of 7e-15 each, and slip adds them up.
    EXPECT_LT((rig.force(0) - force).norm(), 40 * 1e-12);
    EXPECT_NEAR(rig.totals.stored, stored, 40 * 1e-13);
  }
}

// EXACT: room for the forces stays while it suffices, so that memory is not given out anew at each search; it grows
// with the arcs.
TEST(ContactHistory, KeepsItsRoom) {
  Scene scene = nodal_scene();
  scene.contacts = {mohr_coulomb(100, 0.3)};
  for (int i = 0; i < 2; ++i) add_body(scene, polygonal_disc("disc", 2, 3000), BodyKind::rigid, {1.999 * i, 0}, i);
  ContactRig rig(scene);
  rig.refresh();
  const int room = rig.contact.table().entries();
  const auto nodes = [&] { return rig.contact.contact_pairs()[0].forces(0).count; };
  const int few = nodes();
  for (int i = 0; i < 5; ++i) {
    rig.move(1, {i % 2 == 0 ? -1e-3 : 1.1e-3, 0});
    rig.refresh();
    EXPECT_NE(nodes(), few);
    EXPECT_EQ(rig.contact.table().entries(), room);
  }
  rig.move(1, {-0.3, 0});
  rig.refresh();
  EXPECT_GE(rig.contact.table().entries(), 2 * nodes());
  EXPECT_GT(rig.contact.table().entries(), room);
}

// EXACT: a grain some whole periods away feels the same.
TEST(ContactHistory, WholePeriodsChangeNothing) {
  const auto forces = [](double shift) {
    Scene scene = block_on_floor(1 + shift);
    add_body(scene, polygonal_disc("disc", 1, 31), BodyKind::rigid, {1.1 - 2 * shift, 0.97}, 0.2);
    ContactRig rig(scene);
    rig.step();
    rig.move(0, {0.004, 0});
    rig.step();
    std::vector<double> result;
    for (int body = 0; body < 3; ++body)
      for (int k = 0; k < rig.count(body); ++k)
        result.push_back(rig.force(body, k).x()), result.push_back(rig.force(body, k).y());
    return result;
  };
  const std::vector<double> here = forces(0);
  for (const double shift : {4.0, -4.0, 20.0, -400.0}) {
    const std::vector<double> there = forces(shift);
    double worst = 0, magnitude = 0;
    for (std::size_t i = 0; i < here.size(); ++i)
      worst = std::max(worst, std::abs(here[i] - there[i])), magnitude += std::abs(here[i]);
    EXPECT_GT(magnitude, 1);
    // kn l times the rounding of coordinates as large as twice the shift.
    EXPECT_LT(worst, 100 * 4e-16 * (4 + 2 * std::abs(shift))) << shift;
  }
}

// EXACT: a refresh at every step, or only when needed: the same forces but for the order of sums.
TEST(ContactHistory, SurvivesARefresh) {
  ContactRig lazy(block_on_floor(0.035)), eager(block_on_floor(0.035));
  for (int step = 0; step < 200; ++step) {
    for (ContactRig* rig : {&lazy, &eager}) rig->move(0, {0.007 * std::sin(0.1 * step), 0.0005 * std::cos(0.2 * step)});
    eager.refresh();
    lazy.step();
    eager.step();
    EXPECT_LT((lazy.force(0) - eager.force(0)).norm(), 1e-13);
    EXPECT_NEAR(lazy.totals.stored, eager.totals.stored, 1e-14);
    EXPECT_EQ(lazy.totals.contacts, eager.totals.contacts);
  }
  EXPECT_NEAR(lazy.dissipated, eager.dissipated, 1e-13);
  EXPECT_GT(lazy.dissipated, 0.01);
  EXPECT_GT(lazy.contact.refreshes(), 3);
  EXPECT_LT(lazy.contact.refreshes(), 100);
  EXPECT_GE(eager.contact.refreshes(), 200);
}

// EXACT: two discs that turn against each other like gears do not slip, also where the arc coordinates pass their
// seams. Facets tilt the force by up to half of their turning angle, 0.079; a lost period would mean slip at the limit,
// 0.29.
TEST(ContactHistory, PassesTheSeamOfTheOutline) {
  Scene scene = nodal_scene();
  scene.contacts = {mohr_coulomb(100, floor_friction)};
  for (int i = 0; i < 2; ++i) add_body(scene, polygonal_disc("disc", 2, 40), BodyKind::rigid, {2.02 * i, 0});
  ContactRig rig(scene);
  constexpr int steps = 1600;
  double largest_shear = 0;
  for (int step = 0; step <= 2 * steps; ++step) {
    const double angle = 2 * M_PI * step / steps;
    rig.rigid(0)[2] = 0.1 + angle;
    rig.rigid(1)[2] = -angle;  // counter-rotating like gears: no relative motion of the surfaces
    rig.rigid(1)[0] = 1.98;
    rig.step();
    largest_shear = std::max(largest_shear, std::abs(rig.force(1).y()) / std::max(rig.force(1).norm(), 1e-3));
  }
  EXPECT_LT(largest_shear, 0.08);
}

// EXACT: a disc that turns beside one at rest slides alike with each of its facets, in steps of a fortieth of one: also
// those at the end and the start of its outline. A record that is lost there has to slip anew, two steps to the limit.
TEST(ContactHistory, FacetsSlideAlikeAllAroundTheOutline) {
  constexpr int sides = 40, per_facet = 40;
  Scene scene = nodal_scene();
  scene.contacts = {mohr_coulomb(100, floor_friction)};
  for (int i = 0; i < 2; ++i) add_body(scene, polygonal_disc("disc", 2, sides), BodyKind::rigid, {1.98 * i, 0});
  for (const int direction : {1, -1}) {
    ContactRig rig(scene);
    std::vector<Vec2> forces;
    for (int step = 0; step < 3 * sides * per_facet / 2; ++step) {
      rig.rigid(0)[2] = 0.03 + direction * 2 * M_PI * step / (sides * per_facet);
      rig.step();
      forces.push_back(rig.force(1));
      if (step < 3 * per_facet) continue;
      ASSERT_LT((forces[step] - forces[step - per_facet]).norm(), 1e-10) << "step " << step;
    }
    EXPECT_NEAR(std::abs(forces.back().y() / forces.back().x()), floor_friction, 0.1) << "it slides";
    EXPECT_GT(rig.contact.refreshes(), sides) << "all around";
  }
}

// EXACT, bit by bit: a refresh in place changes nothing.
TEST(ContactHistory, RefreshInPlaceChangesNothing) {
  ContactRig rig(block_on_floor(0.035));
  rig.step();
  rig.move(0, {0.004, 0});
  rig.step();
  const Vec2 force = rig.force(0);
  for (int i = 0; i < 5; ++i) {
    rig.refresh();
    rig.step();
    EXPECT_EQ(rig.force(0), force);
  }
}

/// EXACT: what no history can have, as in a checkpoint of something else, is refused.
TEST(ContactHistory, refuses_other_columns) {
  ContactHistory history;
  history.resize(16);
  EXPECT_NO_THROW(history.loaded());
  history.numbers.pop_back();
  EXPECT_THROW(history.loaded(), ArchiveError);
}

/// EXACT: so are contacts that no search leaves behind, before anything follows from them.
TEST(PairTable, refuses_other_bodies) {
  Scene scene = nodal_scene();
  scene.contacts = {frictionless(100)};
  for (int i = 0; i < 2; ++i) add_body(scene, outline_shape("", regular(12, 0.2, 0)), BodyKind::rigid, {0.41 * i, 0});
  ContactRig rig(scene);
  rig.refresh();
  const auto with = [&](auto&& change) {
    PairTable table = rig.contact.table();
    table.visit([&](const char*, auto& value) {
      if constexpr (requires { value.front().segments; }) change(value.front());
    });
    return table;
  };
  EXPECT_NO_THROW(with([](ContactPair&) {}).loaded());
  const auto far = [](ContactPair& p) { p.nodes[0].begin += 12 << 24, p.segments[0].begin += 12 << 24; };
  EXPECT_NO_THROW(with(far).loaded()) << "as along a wall, periods away";
  EXPECT_THROW(with([](ContactPair& p) { p.second = 2; }).loaded(), ArchiveError);
  EXPECT_THROW(with([](ContactPair& p) { p.first = -1; }).loaded(), ArchiveError);
  EXPECT_THROW(with([](ContactPair& p) { p.first = 1, p.second = 0; }).loaded(), ArchiveError);
  EXPECT_THROW(with([](ContactPair& p) { p.images.x = 1 << 30; }).loaded(), ArchiveError);
  EXPECT_THROW(with([](ContactPair& p) { p.nodes[0].begin = 1660944399; }).loaded(), ArchiveError);
  EXPECT_THROW(with([](ContactPair& p) { p.segments[1].count = -1; }).loaded(), ArchiveError);
  EXPECT_THROW(with([](ContactPair& p) { p.record[1] = 1 << 20; }).loaded(), ArchiveError);
  EXPECT_THROW(with([](ContactPair& p) { p.entry[0] = 3; }).loaded(), ArchiveError) << "not at an eight";
  for (const char* of : {"record_room", "entry_room"}) {
    PairTable table = rig.contact.table();
    table.visit([&](const std::string& name, auto& value) {
      if constexpr (std::is_same_v<decltype(value), int&>) value += name == of ? 3 : 0;
    });
    EXPECT_THROW(table.loaded(), ArchiveError) << of;
  }
}

}  // namespace
}  // namespace pliant
