// How far bodies have moved against each other since something was found of them.
#include "contact/pair_watch.hpp"

#include <gtest/gtest.h>

#include <type_traits>
#include <vector>

#include "core/archive.hpp"
#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

/// Six small bodies, and one above each.
Scene two_rows() {
  Scene scene = bare_scene();
  scene.contacts = {frictionless(100)};
  for (int i = 0; i < 12; ++i) {
    const int column = i / 2, row = i % 2;
    add_body(scene, outline_shape("", regular(8 + i % 5, 0.2, 0.1 * i)), BodyKind::rigid,
             {0.43 * column, 0.2 + 0.39 * row});
  }
  return scene;
}

/// EXACT: bodies that shake and spin where they are do not make the broad phase look again, however often references
/// of theirs are renewed; one that leaves does.
TEST(PairWatch, sweeps_no_more_for_what_shakes_and_spins) {
  ContactRig rig(two_rows());
  PairWatch watch(rig.model, rig.contact.skin(), 0);
  rig.show();
  EXPECT_TRUE(watch.update(rig.outlines.position, rig.outlines.position));
  for (int pair = 0; pair < watch.count(); ++pair) watch.searched(pair, rig.outlines.position);
  std::size_t searched = 0;
  for (int step = 0; step < 400; ++step) {
    for (int body = 0; body < 12; ++body) rig.turn(body, body % 2 == 0 ? 0.3 : (step % 4 < 2 ? 0.05 : -0.05));
    rig.show();
    watch.is_used_up(rig.outlines.position);
    EXPECT_FALSE(watch.update(rig.outlines.position, rig.outlines.position));
    for (int pair : watch.used_up(rig.outlines.position)) watch.searched(pair, rig.outlines.position), ++searched;
    EXPECT_FALSE(watch.is_used_up(rig.outlines.position));
  }
  EXPECT_GT(searched, 1000) << "the pairs of those that spin";
  rig.move(11, {6 * rig.contact.skin(), 0});
  rig.show();
  EXPECT_TRUE(watch.is_used_up(rig.outlines.position));
  EXPECT_TRUE(watch.update(rig.outlines.position, rig.outlines.position));
}

/// EXACT: pairs that are searched where a step begins hold at its end if they go less than a skin in it.
TEST(PairWatch, tells_whether_what_was_searched_holds_on_trial) {
  ContactRig rig(two_rows());
  for (const double way : {0.7, 1.3}) {
    PairWatch watch(rig.model, rig.contact.skin(), 0);
    rig.show();
    watch.update(rig.outlines.position, rig.outlines.position);
    for (int pair = 0; pair < watch.count(); ++pair) watch.searched(pair, rig.outlines.position);
    rig.move(11, {0.5 * rig.contact.skin(), 0});
    rig.show();
    const OutlineField begin = rig.outlines.position;
    rig.move(11, {way * rig.contact.skin(), 0});
    rig.show();
    EXPECT_TRUE(watch.is_used_up(rig.outlines.position));
    EXPECT_FALSE(watch.update(begin, rig.outlines.position));
    const std::vector<int> pairs = watch.used_up(begin);
    EXPECT_FALSE(pairs.empty());
    for (int pair : pairs) watch.searched(pair, begin);
    EXPECT_EQ(watch.hold(pairs, rig.outlines.position), way < 1);
  }
}

/// EXACT: of two bodies that drift together the ways against each other are kept to a ten-thousandth of the skin,
/// however far they come and however often their references are renewed.
TEST(NodeWays, are_known_however_far_bodies_drift) {
  ContactRig rig(two_rows());
  const double skin = rig.contact.skin();
  rig.show();
  OutlineField reference = rig.outlines.position;
  std::vector<Box> boxes(rig.model.bodies.size());
  const auto look = [&] {
    rig.show();
    for (int b = 0; b < 2; ++b) boxes[b] = box_of_ways(rig.model, b, rig.outlines.position, reference);
    return WaysSoFar{rig.outlines.position, reference, boxes};
  };
  NodeWays ways(rig.model);
  ways.set_bodies({0, 1});
  for (int entry = 0; entry < 2; ++entry) ways.look(entry, look());
  for (int step = 1; step <= 100; ++step) {
    for (int body = 0; body < 2; ++body) rig.move(body, {1e4, -1e4});
    rig.move(1, {0, 0.005 * skin});
    const WaysSoFar now = look();
    EXPECT_NEAR(relative_way(ways.way(0, now), ways.way(1, now)), 0.005 * step * skin, 1e-4 * skin) << step;
    if (step % 3 > 0) continue;
    for (int entry = 0; entry < 2; ++entry) ways.take_new_reference(entry, now);
    reference = rig.outlines.position;
  }
}

/// EXACT: what a checkpoint has of other pairs is refused.
TEST(PairWatch, of_other_pairs_is_refused) {
  ContactRig rig(two_rows());
  PairWatch watch(rig.model, rig.contact.skin(), 0);
  rig.show();
  watch.update(rig.outlines.position, rig.outlines.position);
  EXPECT_NO_THROW(watch.loaded());
  watch.visit([](const char*, auto& value) {
    if constexpr (std::is_same_v<decltype(value), std::vector<double>&>) value.push_back(0);
  });
  EXPECT_THROW(watch.loaded(), ArchiveError);
}

/// EXACT: what a checkpoint has of other bodies is refused.
TEST(NodeWays, of_other_bodies_are_refused) {
  ContactRig rig(two_rows());
  NodeWays ways(rig.model);
  ways.set_bodies({0, 1});
  EXPECT_NO_THROW(ways.restore_bodies({2, 3}));
  EXPECT_THROW(ways.restore_bodies({0, 12}), ArchiveError) << "there are twelve";
  EXPECT_THROW(ways.restore_bodies({-1, 0}), ArchiveError);
  EXPECT_THROW(ways.restore_bodies({0}), ArchiveError) << "two are known";
}

}  // namespace
}  // namespace pliant
