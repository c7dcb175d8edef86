// How far bodies have moved against each other since something was found of them.
#include "contact/verlet_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Geometry>

#include "contact/stiffness_bound.hpp"
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
TEST(VerletList, sweeps_no_more_for_what_shakes_and_spins) {
  ContactRig rig(two_rows());
  VerletList watch(rig.model, rig.contact.skin(), 0);
  rig.show();
  EXPECT_TRUE(watch.update(rig.outlines.position, rig.outlines.position));
  for (int pair = 0; pair < watch.count(); ++pair) watch.searched(pair, rig.outlines.position);
  std::size_t searched = 0;
  for (int step = 0; step < 400; ++step) {
    for (int body = 0; body < 12; ++body) rig.turn(body, body % 2 == 0 ? 0.3 : (step % 4 < 2 ? 0.05 : -0.05));
    rig.show();
    watch.skin_is_exceeded(rig.outlines.position);
    EXPECT_FALSE(watch.update(rig.outlines.position, rig.outlines.position));
    for (int pair : watch.pairs_to_search(rig.outlines.position))
      watch.searched(pair, rig.outlines.position), ++searched;
    EXPECT_FALSE(watch.skin_is_exceeded(rig.outlines.position));
  }
  EXPECT_GT(searched, 1000) << "the pairs of those that spin";
  rig.move(11, {6 * rig.contact.skin(), 0});
  rig.show();
  EXPECT_TRUE(watch.skin_is_exceeded(rig.outlines.position));
  EXPECT_TRUE(watch.update(rig.outlines.position, rig.outlines.position));
}

/// EXACT: pairs that are searched where a step begins hold at its end if they go less than a skin in it.
TEST(VerletList, tells_whether_what_was_searched_holds_on_trial) {
  ContactRig rig(two_rows());
  for (const double displacement : {0.7, 1.3}) {
    VerletList watch(rig.model, rig.contact.skin(), 0);
    rig.show();
    watch.update(rig.outlines.position, rig.outlines.position);
    for (int pair = 0; pair < watch.count(); ++pair) watch.searched(pair, rig.outlines.position);
    rig.move(11, {0.5 * rig.contact.skin(), 0});
    rig.show();
    const OutlineField begin = rig.outlines.position;
    rig.move(11, {displacement * rig.contact.skin(), 0});
    rig.show();
    EXPECT_TRUE(watch.skin_is_exceeded(rig.outlines.position));
    EXPECT_FALSE(watch.update(begin, rig.outlines.position));
    const std::vector<int> pairs = watch.pairs_to_search(begin);
    EXPECT_FALSE(pairs.empty());
    for (int pair : pairs) watch.searched(pair, begin);
    EXPECT_EQ(watch.hold(pairs, rig.outlines.position), displacement < 1);
  }
}

/// After a step.
struct SearchedStep {
  bool searched;
  int contacts, pairs;            ///< nodes in touch; pairs with candidates
  std::vector<double> stiffness;  ///< [bodies] bounds, N/m
};

/// Bodies of all forms that move, turn and shake, seen along axes that are turned by an angle.
std::vector<SearchedStep> searches_along(double angle) {
  const Eigen::Rotation2Dd turned(angle);
  Random random(21);
  Scene scene = bare_scene();
  scene.contacts = {frictionless(100)};
  for (int i = 0; i < 30; ++i) {
    const Vec2 place{0.75 * (i % 6) + random.uniform(0, 0.1), 0.75 * (i / 6) + random.uniform(0, 0.1)};
    const Points outline = i % 3 == 0   ? regular(8 + i % 7, 0.35, 0.1 * i)
                           : i % 3 == 1 ? refined({{-0.45, -0.1}, {0.45, -0.1}, {0.45, 0.1}, {-0.45, 0.1}}, 0.1)
                                        : refined({{-0.3, -0.3}, {0.3, -0.3}, {0.3, 0.3}, {-0.3, 0.3}}, 0.1);
    add_body(scene, outline_shape("", outline), BodyKind::rigid, turned * place, random.uniform(0, 6) + angle);
  }
  ContactRig rig(scene);
  std::vector<Vec2> velocity;
  std::vector<double> spin;
  const double skin = rig.contact.skin();
  for (int i = 0; i < 30; ++i) {
    velocity.push_back({skin * random.uniform(-0.1, 0.1), skin * random.uniform(-0.1, 0.1)});
    spin.push_back(skin * random.uniform(-0.2, 0.2));
  }
  StiffnessBound bound(rig.model);
  std::vector<SearchedStep> result;
  for (int step = 0; step < 300; ++step) {
    for (int i = 0; i < 30; ++i) {
      const Vec2 shake{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
      rig.move(i, turned * (velocity[i] + skin * shake));
      rig.turn(i, spin[i]);
    }
    SearchedStep seen{rig.evaluate(), rig.totals.contacts, 0, {}};
    rig.commit();
    if (seen.searched) bound.update(rig.contact, std::vector<double>(30, 1.0));
    for (int i = 0; i < 30; ++i) {
      const std::vector<double> of_nodes = bound.of_body(rig.contact, i);
      seen.stiffness.push_back(std::accumulate(of_nodes.begin(), of_nodes.end(), 0.0));
    }
    for (const ContactPair& contact_pair : rig.contact.contact_pairs()) seen.pairs += !contact_pair.is_empty();
    result.push_back(seen);
  }
  return result;
}

/// EXACT: when candidates are searched, and what they may bear at most, does not depend on the axes: the stable step
/// depends on both. Coordinates of 5 gather errors of 300 times 1e-15, shares of segments of 0.1 ten times as much, and
/// some hundred nodes add up such shares of their stiffness, 100 times 0.1.
TEST(VerletList, searches_along_no_axes) {
  const std::vector<SearchedStep> plain = searches_along(0);
  const auto searches = std::ranges::count_if(plain, [](const SearchedStep& seen) { return seen.searched; });
  EXPECT_GT(searches, 20);
  EXPECT_LT(searches, 280);
  for (const double angle : {0.65, 1.3, 2.2}) {
    const std::vector<SearchedStep> turned = searches_along(angle);
    for (std::size_t step = 0; step < plain.size(); ++step) {
      SCOPED_TRACE("step " + std::to_string(step) + ", turned by " + std::to_string(angle));
      ASSERT_EQ(turned[step].searched, plain[step].searched);
      ASSERT_EQ(turned[step].contacts, plain[step].contacts);
      ASSERT_EQ(turned[step].pairs, plain[step].pairs);
      for (std::size_t body = 0; body < 30; ++body)
        ASSERT_NEAR(turned[step].stiffness[body], plain[step].stiffness[body], 3e-9);
    }
  }
}

/// EXACT: of two bodies that drift together the displacements against each other are kept to a ten-thousandth of the
/// skin, however far they come and however often their references are renewed.
TEST(NodeDisplacements, are_known_however_far_bodies_drift) {
  ContactRig rig(two_rows());
  const double skin = rig.contact.skin();
  rig.show();
  OutlineField reference = rig.outlines.position;
  std::vector<DisplacementDisc> discs(rig.model.bodies.size());
  const auto look = [&] {
    rig.show();
    for (int b = 0; b < 2; ++b) discs[b] = displacement_disc(rig.model, b, rig.outlines.position, reference);
    return DisplacementsSoFar{rig.outlines.position, reference, discs};
  };
  NodeDisplacements displacements(rig.model);
  displacements.set_bodies({0, 1});
  for (int entry = 0; entry < 2; ++entry) displacements.set_reference(entry, look());
  for (int step = 1; step <= 100; ++step) {
    for (int body = 0; body < 2; ++body) rig.move(body, {1e4, -1e4});
    rig.move(1, {0, 0.005 * skin});
    const DisplacementsSoFar now = look();
    EXPECT_NEAR(relative_displacement(displacements.displacement(0, now), displacements.displacement(1, now)),
                0.005 * step * skin, 1e-4 * skin)
        << step;
    if (step % 3 > 0) continue;
    for (int entry = 0; entry < 2; ++entry) displacements.reset_reference(entry, now);
    reference = rig.outlines.position;
  }
}

/// EXACT: what a checkpoint has of other pairs is refused.
TEST(VerletList, of_other_pairs_is_refused) {
  ContactRig rig(two_rows());
  VerletList watch(rig.model, rig.contact.skin(), 0);
  rig.show();
  watch.update(rig.outlines.position, rig.outlines.position);
  EXPECT_NO_THROW(watch.loaded());
  watch.visit([](const char*, auto& value) {
    if constexpr (std::is_same_v<decltype(value), std::vector<double>&>) value.push_back(0);
  });
  EXPECT_THROW(watch.loaded(), ArchiveError);
}

/// EXACT: what a checkpoint has of other bodies is refused.
TEST(NodeDisplacements, of_other_bodies_are_refused) {
  ContactRig rig(two_rows());
  NodeDisplacements displacements(rig.model);
  displacements.set_bodies({0, 1});
  EXPECT_NO_THROW(displacements.restore_bodies({5, 6})) << "of as many nodes";
  EXPECT_THROW(displacements.restore_bodies({0, 12}), ArchiveError) << "there are twelve";
  EXPECT_THROW(displacements.restore_bodies({-1, 0}), ArchiveError);
  EXPECT_THROW(displacements.restore_bodies({0}), ArchiveError) << "two are known";
  displacements.visit([](const char* name, auto& values) {
    if (name == std::string("x")) values.pop_back();
  });
  EXPECT_THROW(displacements.restore_bodies({0, 1}), ArchiveError) << "one number less";
}

}  // namespace
}  // namespace pliant
