// Contact of the reference solver by itself: ways along outlines, seams and periods, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "reference/contact_needle.hpp"

namespace pliant {
namespace {

using namespace testing;
using reference::ContactElement;
using reference::ContactOutline;
using reference::ContactResult;
using reference::Contacts;

// ---- ways along outlines

// EXACT: sticking without limit, a tip that circles a regular polygon of n sides at a gap g outside goes n l along
// faces and 2 pi g around corners; inside it goes n (l - 2 |g| tan(pi/n)). Steps within a corner count the sine of the
// turn, an error of its square over 6.
TEST(ReferenceContactWays, AroundAPolygon) {
  constexpr int n = 12, steps = 1200;
  const double half = M_PI / n, l = 1, outer = l / (2 * std::sin(half)), apothem = outer * std::cos(half);
  for (const double gap : {0.03, -0.03})
    for (const int turn : {1, -1}) {
      Needle needle(cohesive(kn, 5, 0.08, 1e6), n);
      double slip = 0;
      for (int step = 0; step <= steps; ++step) {
        const double angle = turn * 2 * M_PI * (step + 0.5) / steps, within = std::remainder(angle - half, 2 * half);
        double radius = (apothem + gap) / std::cos(within);
        const double off = half - std::abs(within);
        if (gap > 0 && std::abs(radius * std::sin(within)) > l / 2)
          radius = outer * std::cos(off) + std::sqrt(gap * gap - std::pow(outer * std::sin(off), 2));
        needle.point_at(radius * Vec2(std::cos(angle), std::sin(angle)));
        slip = -needle.element().shear / kn;
        needle.contacts->accept();
      }
      const double expected = gap > 0 ? n * l + 2 * M_PI * gap : n * (l + 2 * gap * std::tan(half));
      EXPECT_NEAR(slip, turn * expected, gap > 0 ? 1e-3 : 1e-12);
    }
}

// A square on a wall of 20 segments in a period of 2, both as contact sees them. It moves over the wall, twice over the
// seam.
std::vector<Points> forces_on_a_wall(double start, int images) {
  Scene scene = nodal_scene();
  scene.period = 2;
  scene.contacts = {mohr_coulomb(kn, 0.3, 0.02)};
  Points wall, square = rectangle(0.35, 0.35, 0.07);
  for (int i = 0; i < 20; ++i) wall.emplace_back(2 - 0.1 * i, 0);
  std::vector<ContactOutline> outlines{
      {0, 20, -2, wall, "hard", "floor", true, BodyKind::rigid},
      {20, static_cast<int>(square.size()), 0, square, "hard", "square", false, BodyKind::rigid}};
  Contacts contacts(scene, outlines);
  std::vector<Points> history;
  for (int step = 0; step <= 150; ++step) {
    Points x = wall;
    for (Vec2& point : x) point.x() += 2 * images;  // the wall itself has moved around as well
    const double s = step / 150.0;
    for (const Vec2& point : square)
      x.push_back(point + Vec2(start + 5 * s + 0.3 * std::sin(20 * s), -0.01 - 0.005 * std::sin(9 * s)));
    const ContactResult result = contacts.evaluate(x);
    contacts.accept();
    const Points force = forces_on_nodes(result, x.size());
    history.emplace_back(force.begin() + 20, force.end());
  }
  return history;
}

// EXACT: nothing tells one place of the flat wall from another that is some of its segments away, nor one turn from
// another. Rounding: coordinates of order 10, hence gaps to 1e-15, times kn.
TEST(ReferenceContactWays, SeamAndPeriodAreInvisible) {
  const std::vector<Points> expected = forces_on_a_wall(0.523, 0);
  double largest = 0;
  for (const auto& [start, images] :
       {std::pair(1.223, 0), std::pair(2.523, 0), std::pair(0.523, 3), std::pair(-5.477, -2)}) {
    const std::vector<Points> found = forces_on_a_wall(start, images);
    for (std::size_t step = 0; step < expected.size(); ++step)
      for (std::size_t i = 0; i < expected[step].size(); ++i) {
        EXPECT_LT((found[step][i] - expected[step][i]).norm(), 1e-12) << start << " " << step;
        largest = std::max(largest, std::abs(found[step][i].x()));
      }
  }
  EXPECT_GT(largest, 0.01) << "or there was no friction";
}

// EXACT: a pair of discs far apart but for the period feels what it feels side by side.
TEST(ReferenceContactWays, ImagesOfBodies) {
  const auto sum_of_forces = [](double shift) {
    Scene scene = nodal_scene();
    scene.period = 3;
    scene.contacts = {mohr_coulomb(kn, 0.3)};
    const Points disc = regular(24, 0.5);
    Contacts contacts(scene, {{0, 24, 0, disc, "hard", "a", false, BodyKind::rigid},
                              {24, 24, 0, disc, "hard", "b", false, BodyKind::rigid}});
    Points total(48, Vec2(0, 0));
    for (int step = 0; step < 30; ++step) {
      Points x = disc;
      for (const Vec2& point : disc) x.push_back(point + Vec2(0.97 + shift, 0.01 * step));
      const Points now = forces_on_nodes(contacts.evaluate(x), x.size());
      for (std::size_t i = 0; i < now.size(); ++i) total[i] += now[i];
      contacts.accept();
    }
    return total;
  };
  const Points expected = sum_of_forces(0), found = sum_of_forces(-9);
  EXPECT_GT(std::abs(expected[0].y()), 0.01);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LT((found[i] - expected[i]).norm(), 1e-11);
}

// ---- what is refused

TEST(ReferenceContactStates, RefusesWhatItDoesNotHave) {
  const auto refused = [](Scene scene) {
    if (scene.contacts.empty()) scene.contacts = {frictionless(kn)};
    const ContactOutline first{0, 6, 0, regular(6, 1), "hard", "a", false, BodyKind::rigid};
    ContactOutline second = first;
    second.first = 6;
    try {
      Contacts(scene, {first, second});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Scene scene = nodal_scene();
  EXPECT_EQ(refused(scene), "");
  scene.contact.length = ContactLength::current;
  EXPECT_NE(refused(scene).find("length"), std::string::npos);
  scene = nodal_scene();
  scene.contact.self_contact = true;
  EXPECT_NE(refused(scene).find("self_contact"), std::string::npos);
  scene = nodal_scene();
  scene.contacts = {frictionless(kn)};
  scene.contacts[0].restitution = 0.9;
  EXPECT_NE(refused(scene).find("restitution"), std::string::npos);
  scene.contacts[0].restitution = 1;
  EXPECT_EQ(refused(scene), "");
  scene.contacts[0].stiffness.reset();
  EXPECT_NE(refused(scene).find("auto"), std::string::npos);
  scene.contacts = {cohesive(10, 0.5, 0.02, 0.4)};
  EXPECT_NE(refused(scene).find("range"), std::string::npos);
}

}  // namespace
}  // namespace pliant
