// Contact with images along both periods of a cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/lattice.hpp"
#include "support/contact_rig.hpp"
#include "support/random.hpp"

namespace pliant::testing {
namespace {

Scene cell_scene(const Vec2& periods) {
  Scene scene = nodal_scene();
  scene.cell.emplace();
  scene.cell->periods = periods;
  scene.contacts = {mohr_coulomb(100, 0.3)};
  return scene;
}

// EXACT: the same pairs and images as brute force, in cells of any tilt and in flat ones.
TEST(CellBroadPhase, equals_all_pairs) {
  Random random(3);
  for (int sample = 0; sample < 100; ++sample) {
    const double tilt = sample % 3 == 0 ? 0 : random.uniform(-4, 4);
    const Lattice lattice{random.uniform(1, 3), random.uniform(-0.3, 0.3), tilt, random.uniform(0.7, 3)};
    if (area_of(lattice) < 0.5) continue;  // a flat one has more images than the brute force looks at
    std::vector<Box> boxes;
    const double widest = sample % 4 == 0 ? 2.5 : 0.6, margin = random.uniform(0, 0.1);
    for (int i = 0; i < 1 + random.below(25); ++i) {
      const double x = random.uniform(-7, 7), y = random.uniform(-7, 7);
      boxes.push_back({x, x + random.uniform(0.05, widest), y, y + random.uniform(0.05, widest)});
    }
    std::vector<BodyPair> expected;
    for (int a = 0; a < static_cast<int>(boxes.size()); ++a)
      for (int b = a; b < static_cast<int>(boxes.size()); ++b)
        for (int i = -90; i <= 90; ++i)
          for (int j = -40; j <= 40; ++j) {
            const Images n{i, j};
            if (a == b && n <= Images{}) continue;
            const Vec2 s = lattice.shift(n);
            const Box &p = boxes[static_cast<std::size_t>(a)], &q = boxes[static_cast<std::size_t>(b)];
            if (overlap(p.x_min, p.x_max, q.x_min + s.x(), q.x_max + s.x(), margin) &&
                overlap(p.y_min, p.y_max, q.y_min + s.y(), q.y_max + s.y(), margin))
              expected.push_back({a, b, n});
          }
    const std::vector<BodyPair> found = broad_phase_in_cell(boxes, margin, lattice);
    EXPECT_TRUE(found == expected) << "sample " << sample << ": " << found.size() << " pairs, brute force "
                                   << expected.size();
  }
}

// EXACT: the shortest basis spans the same lattice, and its vectors are at 60 to 120 degrees.
TEST(Lattice, has_a_shortest_basis) {
  Random random(5);
  for (int sample = 0; sample < 1000; ++sample) {
    const Lattice lattice{random.uniform(0.5, 2), random.uniform(-1, 1), random.uniform(-30, 30),
                          random.uniform(0.5, 2)};
    if (std::abs(area_of(lattice)) < 0.05) continue;
    const LatticeBasis basis = shortest_basis(lattice), upright = upright_basis(lattice);
    EXPECT_EQ(std::abs(basis.a.x * basis.b.y - basis.a.y * basis.b.x), 1);
    EXPECT_LE(std::abs(basis.lattice.a().dot(basis.lattice.b())), 0.5000001 * basis.lattice.a().squaredNorm());
    EXPECT_LT((lattice.shift(basis.b) - basis.lattice.b()).norm(), 1e-14 * 64);
    EXPECT_LE(std::abs(upright.lattice.b().dot(lattice.a())), 0.5000001 * lattice.a().squaredNorm());
  }
}

/// Forces on the nodes of a body, one after another.
Points forces_on(const ContactRig& rig, int body) {
  Points forces;
  for (int k = 0; k < rig.count(body); ++k) forces.push_back(rig.force(body, k));
  return forces;
}

double largest_force_difference(const Points& a, const Points& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, (a[k] - b[k]).norm());
  return largest;
}

double largest_force(const Points& forces) {
  double most = 0;
  for (const Vec2& f : forces) most = std::max(most, f.norm());
  return most;
}

// EXACT: two bodies that touch across an edge or a corner of the cell get the forces of the same contact inside.
// Positions of up to 20 are rounded by 4e-15; the stiffness times the length of a node is 20.
TEST(CellImages, touch_over_edges_and_corners_as_inside) {
  for (const ContactQuadrature quadrature : {ContactQuadrature::nodes, ContactQuadrature::segments})
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(-1, 1), std::pair(2, -3)}) {
      Scene scene = cell_scene({4, 3});
      scene.contact.quadrature = quadrature;
      const Vec2 near(0.97 * std::cos(0.7), 0.97 * std::sin(0.7));
      add_body(scene, outline_shape("a", regular(40, 0.5)), BodyKind::rigid, {0.3, 0.4});
      add_body(scene, outline_shape("b", regular(37, 0.5)), BodyKind::rigid, Vec2(0.3, 0.4) + near);
      ContactRig inside(scene);
      scene.grains[1].packing.positions[0] += Vec2(4.0 * x, 3.0 * y);
      ContactRig across(scene);
      for (ContactRig* rig : {&inside, &across}) {
        rig->evaluate(), rig->commit();
        rig->move(1, {0.01, -0.02});  // slip
        rig->evaluate();
      }
      for (int body = 0; body < 2; ++body) {
        EXPECT_GT(largest_force(forces_on(inside, body)), 0.1);
        EXPECT_LT(largest_force_difference(forces_on(inside, body), forces_on(across, body)), 1e-12);
      }
    }
}

// EXACT: a disc wider than both periods touches four images of its own, as each of nine discs in three periods does.
TEST(CellImages, of_a_body_itself_along_both_periods) {
  Scene one = cell_scene({1, 1.02});
  const ShapeSpec disc = outline_shape("disc", regular(48, 0.52));
  add_body(one, disc, BodyKind::rigid, {0.3, 0.4});
  Scene nine = cell_scene({3, 3.06});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) add_body(nine, disc, BodyKind::rigid, {0.3 + i, 0.4 + 1.02 * j});
  ContactRig a(one), b(nine);
  a.evaluate(), b.evaluate();
  EXPECT_EQ(9 * a.totals.contacts, b.totals.contacts);
  EXPECT_GT(a.totals.contacts, 8);
  for (int body = 0; body < 9; ++body) EXPECT_LT(largest_force_difference(forces_on(a, 0), forces_on(b, body)), 1e-12);
}

// EXACT: a cell sheared by whole periods is the same lattice.
TEST(CellImages, of_a_cell_sheared_by_whole_periods_are_the_same) {
  Scene scene = cell_scene({2, 2});
  Random random(8);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      add_body(scene, outline_shape("disc", regular(30 + i + 2 * j, 0.51)), BodyKind::rigid,
               {i + random.uniform(0, 0.05), j + random.uniform(0, 0.05)});
  ContactRig upright(scene), sheared(scene);
  for (const int turns : {1, -3, 17}) {
    sheared.q.lattice.bx = 2.0 * turns;
    upright.refresh(), upright.evaluate(), sheared.refresh(), sheared.evaluate();
    EXPECT_GT(upright.totals.contacts, 12);
    EXPECT_EQ(upright.totals.contacts, sheared.totals.contacts);
    for (int body = 0; body < 4; ++body)
      EXPECT_LT(largest_force_difference(forces_on(upright, body), forces_on(sheared, body)), 1e-12);
  }
}

// EXACT: images move even if bodies do not. The candidates that the list keeps give the forces of a search anew.
TEST(CellImages, that_move_alone_are_searched_in_time) {
  Scene scene = cell_scene({2, 2});
  Random random(9);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      add_body(scene, outline_shape("disc", regular(40, 0.49)), BodyKind::rigid, {1.0 * i, 1.0 * j});
  ContactRig kept(scene);
  int searched = 0, touched = 0;
  for (int step = 0; step < 400; ++step) {
    kept.q.lattice.bx += 0.004, kept.q.lattice.ay -= 0.0005, kept.q.lattice.by -= 0.0002;
    searched += kept.evaluate();
    ContactRig anew(scene);
    anew.q.lattice = kept.q.lattice;
    anew.evaluate();
    touched += anew.totals.contacts > 0;
    EXPECT_EQ(kept.totals.contacts, anew.totals.contacts) << step;
    for (int body = 0; body < 4; ++body)
      EXPECT_LT(std::abs(kept.force(body).x() - anew.force(body).x()), 20.0) << "friction differs, normal forces not";
    kept.commit();
  }
  EXPECT_GT(touched, 50);
  EXPECT_LT(searched, 250) << "not in every step";
}

}  // namespace
}  // namespace pliant::testing
