#include "contact/broad_phase.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using testing::overlap, testing::Random;

struct Boxes {
  Model model;
  std::vector<Box> boxes;
  double margin = 0;
};

// Random boxes of widths up to `widest`, spread over several periods when there is one; walls last, as in a model.
Boxes random_boxes(Random& random, int count, int walls, std::optional<double> period, double widest) {
  Boxes result;
  result.model.scene.period = period;
  result.model.bodies.resize(static_cast<std::size_t>(count + walls));
  result.margin = random.uniform(0, 0.1);
  for (int i = 0; i < count + walls; ++i) {
    const double x = random.uniform(period ? -30 : 0, period ? 40 : 5), y = random.uniform(0, 3);
    result.boxes.push_back({x, x + random.uniform(0.01, widest), y, y + random.uniform(0.01, 0.5)});
    result.model.bodies[i].wall = i >= count;
    if (i >= count) result.boxes[i].x_min = 0, result.boxes[i].x_max = period.value_or(0) * 0.9;
  }
  return result;
}

// All pairs, all images, of a body itself too: what docs/method.md 4 asks for.
std::vector<BodyPair> all_pairs(const Boxes& in) {
  std::vector<BodyPair> pairs;
  const double period = in.model.scene.period.value_or(0);
  const int images = period > 0 ? 90 : 0;
  for (int a = 0; a < static_cast<int>(in.boxes.size()); ++a)
    for (int b = a; b < static_cast<int>(in.boxes.size()); ++b) {
      if (a == b && in.model.bodies[a].wall) continue;
      const Box &p = in.boxes[a], &q = in.boxes[b];
      if (!overlap(p.y_min, p.y_max, q.y_min, q.y_max, in.margin)) continue;
      if (in.model.bodies[a].wall || in.model.bodies[b].wall) {
        pairs.push_back({a, b, {}});
        continue;
      }
      for (int k = a == b ? 1 : -images; k <= images; ++k)
        if (overlap(p.x_min, p.x_max, q.x_min + k * period, q.x_max + k * period, in.margin))
          pairs.push_back({a, b, {k, 0}});
    }
  return pairs;
}

void expect_all_pairs(const Boxes& in) {
  const std::vector<BodyPair> expected = all_pairs(in), found = broad_phase(in.model, in.boxes, in.margin);
  EXPECT_TRUE(found == expected) << found.size() << " pairs, brute force " << expected.size();
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
}

// EXACT: the same pairs and images as brute force.
TEST(BroadPhase, EqualsAllPairsWithoutAPeriod) {
  Random random(1);
  for (int sample = 0; sample < 50; ++sample) expect_all_pairs(random_boxes(random, 1 + random.below(80), 0, {}, 0.8));
}

TEST(BroadPhase, EqualsAllPairsAroundThePeriod) {
  Random random(2);
  for (int sample = 0; sample < 50; ++sample) {
    const int count = 1 + random.below(60), walls = random.below(3);
    const double period = random.uniform(1.5, 6);
    expect_all_pairs(random_boxes(random, count, walls, period, 0.5));
  }
}

// Boxes wider than half the period meet their neighbours on both sides: two images of one pair.
TEST(BroadPhase, WideBoxesMeetOnBothSides) {
  Random random(3);
  for (int sample = 0; sample < 50; ++sample) expect_all_pairs(random_boxes(random, 12, 1, 1.0, 0.89));
}

// Boxes wider than the period meet their own images, and further ones of others.
TEST(BroadPhase, BoxesWiderThanThePeriod) {
  Random random(5);
  int own = 0;
  for (int sample = 0; sample < 50; ++sample) {
    const Boxes in = random_boxes(random, 1 + random.below(8), 1, 1.0, 3.5);
    expect_all_pairs(in);
    for (const BodyPair& pair : broad_phase(in.model, in.boxes, in.margin)) own += pair.first == pair.second;
  }
  EXPECT_GT(own, 100);
}

TEST(BroadPhase, KnownPairsAcrossThePeriod) {
  Boxes in;
  in.model.scene.period = 10;
  in.model.bodies.resize(3);
  in.margin = 0.1;
  in.boxes = {{9.5, 10.4, 0, 1}, {0.45, 1, 0, 1}, {-19.5, -19.3, 0, 1}};
  // The second, a period further, begins at 10.45; the third, three periods further, at 10.5; the second sees the third
  // two periods further.
  const std::vector<BodyPair> expected = {{0, 1, {1}}, {0, 2, {3}}, {1, 2, {2}}};
  EXPECT_TRUE(broad_phase(in.model, in.boxes, in.margin) == expected);
}

TEST(BroadPhase, NothingToDo) {
  EXPECT_TRUE(broad_phase(Model{}, {}, 1).empty());
  Random random(4);
  const Boxes one = random_boxes(random, 1, 0, 2.0, 0.5);
  EXPECT_TRUE(broad_phase(one.model, one.boxes, one.margin).empty());
}

}  // namespace
}  // namespace pliant
