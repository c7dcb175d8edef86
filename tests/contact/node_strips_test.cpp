// Outline nodes by strips: nothing that is near is left out.
#include "contact/node_strips.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <set>

#include "bodies/place_outlines.hpp"
#include "contact/deepest_node.hpp"
#include "core/floating_point_traps.hpp"
#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

/// A closed zigzag around the origin, or one along a period, with steps of uneven length: ends of its segments.
std::vector<double> zigzag(int count, double period, Random& random) {
  std::vector<double> x;
  for (int i = 0; i < count; ++i) {
    const double turn = (i + random.uniform(-0.3, 0.3)) / count;
    x.push_back(period > 0 ? turn * period : 3 * std::cos(2 * std::numbers::pi * turn));
  }
  x.push_back(x[0] + period);
  return x;
}

double longest(const std::vector<double>& x) {
  double result = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) result = std::max(result, std::abs(x[i + 1] - x[i]));
  return result;
}

/// From a point to a segment in x alone, by the nearest image of its first node.
double distance_in_x(double point, double a, double b, double period) {
  double off = point - a;
  if (period > 0) off -= period * std::round(off / period);
  return std::max({0.0, std::min(0.0, b - a) - off, off - std::max(0.0, b - a)});
}

/// EXACT: beside a scan of all segments, points inside and far outside, few nodes and many; a node is visited once.
TEST(NodeStrips, finds_what_a_scan_finds) {
  Random random(1);
  for (const double period : {0.0, 7.0})
    for (const int count : {3, 4, 9, 40, 333}) {
      const std::vector<double> x = zigzag(count, period, random);
      const NodeStrips strips(x.data(), count, longest(x), period);
      for (int trial = 0; trial < 200; ++trial) {
        const double point = random.uniform(-12, 12);
        double nearest = std::numeric_limits<double>::infinity(), scanned = nearest;
        std::multiset<int> seen;
        strips.from(
            point,
            [&](int s) {
              seen.insert(s);
              nearest = std::min(nearest, distance_in_x(point, x[s], x[s + 1], period));
            },
            [&] { return nearest; });
        for (int s = 0; s < count; ++s) scanned = std::min(scanned, distance_in_x(point, x[s], x[s + 1], period));
        EXPECT_EQ(nearest, scanned) << count << " nodes, period " << period << ", from " << point;
        for (int s : seen) EXPECT_EQ(seen.count(s), 1U);
      }
    }
}

/// EXACT: all nodes of an interval, also over the edge of the period and where it is longer than that; of a short one
/// not all that there are.
TEST(NodeStrips, shows_all_of_an_interval) {
  Random random(2);
  for (const double period : {0.0, 7.0})
    for (const int count : {3, 40, 333}) {
      const std::vector<double> x = zigzag(count, period, random);
      const NodeStrips strips(x.data(), count, longest(x), period);
      for (int trial = 0; trial < 200; ++trial) {
        const double begin = random.uniform(-12, 12);
        const double end = begin + random.uniform(0, 9);
        std::multiset<int> seen;
        strips.between(begin, end, [&](int node) { seen.insert(node); });
        for (int i = 0; i < count; ++i) {
          const double image = period > 0 ? x[i] + period * std::ceil((begin - x[i]) / period) : x[i];
          if (image >= begin && image <= end) EXPECT_EQ(seen.count(i), 1U) << i << " in " << begin << ", " << end;
          EXPECT_LE(seen.count(i), 1U);
        }
      }
      std::size_t few = 0;
      strips.between(1, 1.01, [&](int) { ++few; });
      if (count == 333) EXPECT_LT(few, 20U);
    }
}

/// EXACT: numbers that a failed step left behind do no harm; all nodes are seen.
TEST(NodeStrips, takes_what_is_no_number) {
  const Untrapped untrapped;
  const double nowhere = std::numeric_limits<double>::quiet_NaN(), far = std::numeric_limits<double>::infinity();
  for (const double bad : {nowhere, far, -far})
    for (const double period : {0.0, 2.0}) {
      const double x[] = {0, bad, 1, 1.5, 0};
      const NodeStrips strips(x, 4, 1, period);
      for (const double from : {0.5, bad}) {
        int visited = 0;
        strips.from(from, [&](int) { ++visited; }, [] { return std::numeric_limits<double>::infinity(); });
        EXPECT_EQ(visited, 4) << bad << ", period " << period << ", from " << from;
      }
    }
}

/// INDEPENDENT: a floor of 800 nodes and a ring of 700, with a disc in either, beside a scan of all nodes and segments.
TEST(DeepestNode, is_the_same_of_long_outlines) {
  for (const bool wall : {true, false})
    for (const double x : {0.02, 1.37, 3.99, 6.5}) {
      Scene scene = bare_scene();
      scene.contacts = {frictionless(100)};
      if (wall) {
        scene.period = 4;
        scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 4.0 / 800)};
      } else {
        add_body(scene, outline_shape("", regular(700, 2, 0.3)), BodyKind::rigid, {0, 0});
      }
      const double angle = x;
      add_body(scene, outline_shape("", regular(40, 0.3, 0.1)), BodyKind::rigid,
               wall ? Vec2(x, 0.297) : Vec2(2.28 * std::cos(angle), 2.28 * std::sin(angle)));
      const ContactRig rig(scene);
      const OutlineField& at = rig.outlines.position;
      double deepest = 0;
      for (int slave = 0; slave < 2; ++slave) {
        const int master = 1 - slave, first = rig.model.outline_offset[master], n = rig.model.outline_of(master).count;
        for (int i = 0; i < rig.model.outline_of(slave).count; ++i) {
          const Vec2 p = at.at(rig.model.outline_offset[slave] + i);
          double nearest = 1e300, depth = 0;
          for (int s = 0; s < n; ++s) {
            const Vec2 a = at.at(first + s), along = Vec2(at.at(first + s + 1) - a), t = along.normalized();
            Vec2 r = p - a;
            if (wall) r.x() -= 4 * std::round(r.x() / 4);
            const double off = (r - std::clamp(r.dot(t), 0.0, along.norm()) * t).norm();
            if (off < nearest) nearest = off, depth = (r.y() * t.x() - r.x() * t.y()) / along.norm();
          }
          deepest = std::max(deepest, depth);
        }
      }
      const DeepestNode found = deepest_node(rig.model, at, {{0, 1, {0}}});
      EXPECT_NEAR(found.depth / found.segment_length, deepest, 1e-9 * deepest) << wall << ", " << x;
      EXPECT_GT(deepest, 0.1) << "they overlap";
    }
}

}  // namespace
}  // namespace pliant
