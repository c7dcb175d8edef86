#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <vector>

#include "reference/contact/contacts.hpp"
#include "support/scenes.hpp"

namespace pliant::testing {

// A polygon with edges of 1 that turn by 30 degrees, and a needle whose tip alone comes near.
struct Needle {
  explicit Needle(const ContactRule& rule, int sides = 12) : corners(regular(sides, 0.5 / std::sin(M_PI / sides))) {
    Scene scene = nodal_scene();
    scene.contacts = {rule};
    const Points needle{{0, 0}, {3, 4}, {-3, 4}}, flat{{0, 0}, {3, 0.5}, {-3, 0.5}};
    reference::ContactOutline first{0, sides, 0, corners, "hard", "polygon", false, BodyKind::rigid}, second = first;
    second.first = sides, second.count = 3, second.reference = flat, second.name = "needle";
    contacts = std::make_unique<reference::Contacts>(scene, std::vector{first, second});
    x = corners;
    x.insert(x.end(), needle.begin(), needle.end());
  }

  Vec2& tip() { return x[corners.size()]; }
  void point_at(const Vec2& place) {
    const Vec2 outward = place.normalized(), side(-outward.y(), outward.x());
    const std::size_t n = corners.size();
    x[n] = place, x[n + 1] = place + 4 * outward - 3 * side, x[n + 2] = place + 4 * outward + 3 * side;
  }
  /// `angle`: from the normal of the segment, beyond its end.
  Vec2 place(int segment, double along, double gap, double angle = 0) const {
    const Vec2 a = x[segment], b = x[(segment + 1) % corners.size()], t = (b - a).normalized(), n(t.y(), -t.x());
    return a + along * (b - a) + gap * (std::cos(angle) * n + std::sin(angle) * t);
  }
  /// The tip's, of which there is one. Besides, corners of the polygon may touch the needle.
  reference::ContactElement element() {
    result = contacts->evaluate(x);
    const int node = static_cast<int>(corners.size());
    std::vector<reference::ContactElement> tips;
    std::copy_if(result.elements.begin(), result.elements.end(), std::back_inserter(tips),
                 [&](const reference::ContactElement& element) { return element.node[0] == node; });
    EXPECT_EQ(tips.size(), 1U);
    return tips.empty() ? reference::ContactElement() : tips.front();
  }

  Points corners, x;
  std::unique_ptr<reference::Contacts> contacts;
  reference::ContactResult result;
};

inline void shake(Points& x, Random& random, double size) {
  for (Vec2& point : x) point += Vec2{random.uniform(-size, size), random.uniform(-size, size)};
}

}  // namespace pliant::testing
