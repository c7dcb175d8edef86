// Candidates stay good until the next refresh, however bodies move together and against each other.
#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "contact/master_window.hpp"
#include "contact/pair_queries.hpp"
#include "contact/stiffness_bound.hpp"
#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

/// How two rows of small bodies move, each step: both by `drift`, the upper one along the lower by `slide`, and down
/// from `height` by `fall` until they touch; each turns by `turn`.
struct Course {
  Vec2 drift{0, 0};
  double slide = 0, height = 0.39, fall = 0, turn = 0;

  Vec2 at(int body, int step) const {
    const int column = body / 2;
    const Vec2 lower = Vec2(0.43 * column, 0.2) + step * drift;
    return body % 2 == 0 ? lower : Vec2(lower + Vec2(step * slide, std::max(0.39, height - step * fall)));
  }
};

/// On a floor that drifts in y as they do, or on none.
Scene rows_on_course(Random& random, const Course& course, bool floor) {
  Scene scene = bare_scene();
  scene.contacts = {frictionless(100)};
  for (int i = 0; i < 12; ++i) {
    const int sides = 8 + random.below(8);
    add_body(scene, outline_shape("", regular(sides, 0.2, random.uniform(0, 1))), BodyKind::rigid, course.at(i, 0));
  }
  if (floor) {
    scene.period = 3;
    scene.walls = {free_wall("floor", Wall::Solid::below, 0.005, 0.15)};
  }
  return scene;
}

struct RefreshCounts {
  int evaluations = 0, refreshes = 0, contacts = 0;
};

/// INDEPENDENT: candidates found just now give the same forces as those found before.
RefreshCounts watch(int sample, const Course& course) {
  Random random(sample + 400);
  const bool floor = sample % 2 == 0;
  const Scene scene = rows_on_course(random, course, floor);
  ContactRig rig(scene), fresh(scene);
  Points before;
  for (int body = 0; body < 12; ++body) before.push_back(course.at(body, 0));
  RefreshCounts seen;
  for (int step = 1; step <= 40; ++step) {
    for (int body = 0; body < 12; ++body) {
      const Vec2 to = course.at(body, step) + Vec2{random.uniform(-0.004, 0.004), random.uniform(-0.004, 0.004)};
      rig.move(body, to - before[body]), fresh.move(body, to - before[body]);
      rig.turn(body, course.turn), fresh.turn(body, course.turn);
      before[body] = to;
    }
    if (floor) rig.move(12, {0, course.drift.y()}), fresh.move(12, {0, course.drift.y()});
    ++seen.evaluations, seen.refreshes += rig.evaluate();
    fresh.refresh(), fresh.evaluate();
    seen.contacts += rig.totals.contacts;
    EXPECT_LT(rig.totals.deepest, 1);
    EXPECT_EQ(rig.totals.contacts, fresh.totals.contacts);
    for (int body = 0; body < static_cast<int>(rig.model.bodies.size()); ++body)
      EXPECT_LT((rig.force(body) - fresh.force(body)).norm(), 1e-12) << "orders of sums may differ";
  }
  return seen;
}

TEST(Refresh, misses_no_contact_whatever_moves) {
  for (const Vec2& drift : {Vec2(0, 0), Vec2(0.5, -0.3)})
    for (const Course& course :
         {Course{drift}, Course{drift, 0.04}, Course{drift, 0, 3, 0.1}, Course{drift, -0.1, 1, 0.03},
          Course{drift, 0, 0.39, 0, 0.07}, Course{drift, 0.02, 0.39, 0, -0.2}}) {
      int contacts = 0;
      for (int sample = 0; sample < 10; ++sample) contacts += watch(sample, course).contacts;
      EXPECT_GT(contacts, 100);
    }
}

/// EXACT: only what bodies do against each other asks for a refresh; a wall's motion along itself is none against what
/// is far.
TEST(Refresh, does_not_see_a_drift) {
  int refreshes = 0, evaluations = 0;
  for (int sample = 1; sample < 20; sample += 2)
    for (const double slide : {0.0, 0.01}) {
      const RefreshCounts still = watch(sample, {{0, 0}, slide}), drifting = watch(sample, {{5, -3}, slide});
      EXPECT_EQ(drifting.refreshes, still.refreshes);
      refreshes += still.refreshes, evaluations += still.evaluations;
    }
  EXPECT_LT(refreshes, evaluations / 2) << "or there is nothing to see";
}

/// EXACT: where one body of twelve moves, pairs without it are searched at the start alone.
TEST(Refresh, searches_pairs_that_moved) {
  Random random(400);
  ContactRig rig(rows_on_course(random, {}, false));
  rig.evaluate();
  const long at_first = rig.contact.pairs_searched();
  const std::vector<ContactPair> contact_pairs = rig.contact.contact_pairs();
  long refreshes = 0;
  for (int step = 0; step < 100; ++step) {
    rig.move(11, {0.002, 0});
    refreshes += rig.evaluate();
  }
  EXPECT_GT(refreshes, 3);
  EXPECT_GT(rig.contact.pairs_searched(), at_first);
  for (const ContactPair& contact_pair : contact_pairs) {
    if (contact_pair.second == 11) continue;
    const auto same = std::ranges::find_if(rig.contact.contact_pairs(), [&](const ContactPair& other) {
      return other.first == contact_pair.first && other.second == contact_pair.second;
    });
    ASSERT_NE(same, rig.contact.contact_pairs().end());
    EXPECT_TRUE(same->nodes[0] == contact_pair.nodes[0] && same->segments[1] == contact_pair.segments[1]);
  }
  EXPECT_LE(rig.contact.pairs_searched() - at_first, 11 * refreshes) << "no more than it has others";
}

/// EXACT: bodies that shake where they are are searched at the start alone, however often others are.
TEST(Refresh, does_not_search_what_only_shakes) {
  Random random(400);
  ContactRig rig(rows_on_course(random, {}, false));
  rig.evaluate();
  const long at_first = rig.contact.pairs_searched();
  long refreshes = 0;
  for (int step = 0; step < 200; ++step) {
    rig.move(11, {0.002, 0});
    for (int body = 0; body < 10; ++body) rig.turn(body, (step + body) % 2 == 0 ? 0.05 : -0.05);
    refreshes += rig.evaluate();
  }
  EXPECT_GT(refreshes, 6);
  EXPECT_LE(rig.contact.pairs_searched() - at_first, 11 * refreshes) << "pairs of the one that moves";
  for (const ContactPair& contact_pair : rig.contact.contact_pairs())
    if (contact_pair.second < 10)
      EXPECT_EQ(contact_pair.found, 1) << contact_pair.first << " and " << contact_pair.second;
}

/// What is remembered of a node, by its body, side, number and the other body.
using Memories = std::map<std::tuple<int, int, int, int>, std::pair<double, double>>;

Memories memories(const ContactRig& rig) {
  Memories all;
  for (const ContactPair& contact_pair : rig.contact.contact_pairs())
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < contact_pair.nodes[side].count; ++i) {
        const int body = side == 0 ? contact_pair.first : contact_pair.second, n = rig.count(body),
                  at = contact_pair.nodes[side].begin + i;
        all[{contact_pair.first, contact_pair.second, side, at - turn_of(at, n) * n}] = {
            rig.committed.number(contact_pair.record[side] + i, ContactHistory::place),
            rig.committed.number(contact_pair.record[side] + i, ContactHistory::slip)};
      }
  return all;
}

struct Carried {
  int nodes = 0, moved = 0, layouts = 0;
};

/// Nodes of a row that slides on another, with friction.
void follow_history(int sample, Carried& carried) {
  Random random(sample + 400);
  const Course course{{0, 0}, 0.002};
  Scene scene = rows_on_course(random, course, false);
  scene.contacts = {mohr_coulomb(100, 0.5, 1)};
  ContactRig rig(scene);
  rig.step();
  for (int step = 1; step <= 300; ++step) {
    for (int body = 0; body < 12; ++body) rig.move(body, course.at(body, step) - course.at(body, step - 1));
    rig.show();
    if (!rig.contact.candidates_hold(rig.outlines.position)) {
      const Memories before = memories(rig);
      const std::vector<ContactPair> old = rig.contact.contact_pairs();
      const auto layout = rig.contact.table().laid_out();
      rig.contact.renew_candidates(rig.outlines, rig.committed);
      for (const auto& [node, now] : memories(rig)) {
        const auto was = before.find(node);
        if (was != before.end() && !std::isnan(was->second.first)) {
          EXPECT_EQ(now, was->second);
          carried.nodes += now.second != 0;
        } else
          EXPECT_EQ(now.second, 0) << "a newcomer";
      }
      if (layout == rig.contact.table().laid_out())
        for (std::size_t p = 0; p < old.size(); ++p)
          carried.moved += old[p].record[0] != rig.contact.contact_pairs()[p].record[0];
      else
        ++carried.layouts;
    }
    rig.step();
  }
}

/// EXACT: nodes keep what is remembered of them, whether their contact pair was searched, grew out of its place or all
/// were laid out anew; nodes that were apart remember nothing.
TEST(Refresh, carries_the_history_along) {
  Carried carried;
  for (int sample = 0; sample < 5; ++sample) follow_history(sample, carried);
  EXPECT_GT(carried.nodes, 30);
  EXPECT_GT(carried.moved, 0);
  EXPECT_GT(carried.layouts, 5);
}

/// EXACT: the bound of stiffness follows the one body that moves; those that it does not meet keep theirs.
TEST(Refresh, bound_of_stiffness_follows) {
  Random random(400);
  ContactRig rig(rows_on_course(random, {}, false));
  rig.evaluate();
  const std::vector<double> compliance(rig.model.bodies.size(), 1.0);
  StiffnessBound bound(rig.model);
  EXPECT_EQ(bound.update(rig.contact, compliance).size(), 12u);
  const std::vector<double> far = bound.of_body(rig.contact, 0), before = bound.of_body(rig.contact, 11);
  auto before_layout = rig.contact.table().laid_out();
  int updates = 0;
  for (int step = 0; step < 200; ++step) {
    rig.move(11, {-0.001, 0.0002});
    if (!rig.evaluate()) continue;
    const auto layout = rig.contact.table().laid_out();
    const std::size_t changed = bound.update(rig.contact, compliance).size();
    updates += changed < 12;
    EXPECT_EQ(changed == 12, layout != before_layout) << "all are looked at where they were laid out anew";
    before_layout = layout;
    EXPECT_EQ(bound.of_body(rig.contact, 0), far);
  }
  EXPECT_GT(updates, 2);
  EXPECT_NE(bound.of_body(rig.contact, 11), before);
}

/// INDEPENDENT: whatever contact pairs were searched, replaced or laid out anew, no body touches over a length of more
/// stiffness than its bound, in which each record counts for both bodies with twice its own.
TEST(Refresh, bound_of_stiffness_holds_on_the_way) {
  int touching = 0, layouts = 0;
  for (int sample = 0; sample < 80; ++sample) {
    Random random(sample / 2 + 400);
    Scene scene = rows_on_course(random, {}, false);
    scene.contact.quadrature = sample % 2 == 0 ? ContactQuadrature::nodes : ContactQuadrature::segments;
    ContactRig rig(scene);
    StiffnessBound bound(rig.model);
    const std::vector<double> compliance(rig.model.bodies.size(), 1.0);
    // Up and down by about a skin, so that contact pairs are kept that go far from where others were laid out.
    double speed[12], swing[12], height[12] = {};
    for (double& v : speed) v = random.uniform(0.05, 0.5);
    for (double& v : swing) v = random.uniform(0.3, 1.5) * rig.contact.skin();
    auto layout = rig.contact.table().laid_out();
    for (int step = 0; step < 300; ++step) {
      for (int body = 1; body < 12; body += 2) {
        const double next = swing[body] * std::sin(speed[body] * step);
        rig.move(body, {0, next - std::exchange(height[body], next)});
      }
      if (rig.evaluate()) bound.update(rig.contact, compliance);
      layouts += layout != rig.contact.table().laid_out();
      layout = rig.contact.table().laid_out();
      std::vector<double> felt(rig.model.bodies.size());
      for (const ContactPair& contact_pair : rig.contact.contact_pairs()) {
        if (contact_pair.is_empty()) continue;
        const double all = stiffness_of(contact_pair.law) * touching_length({rig.model, rig.outlines, contact_pair,
                                                                             rig.contact.skin(), thread_scratch()});
        felt[contact_pair.first] += all, felt[contact_pair.second] += all;
      }
      for (int body = 0; body < 12; ++body) {
        const std::vector<double> most = bound.of_body(rig.contact, body);
        EXPECT_LE(2 * felt[body], std::accumulate(most.begin(), most.end(), 0.0) * (1 + 1e-12))
            << "sample " << sample << ", step " << step << ", body " << body;
        touching += felt[body] > 0;
      }
    }
  }
  EXPECT_GT(touching, 1000);
  EXPECT_GT(layouts, 50);
}

}  // namespace
}  // namespace pliant
