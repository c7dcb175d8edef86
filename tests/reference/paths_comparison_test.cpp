// Distances through bodies, the engine's funnel against the reference solver's corners in sight of each other.
// INDEPENDENT: they share the outline.
#include <gtest/gtest.h>

#include "discretisation/inner_paths.hpp"
#include "geometry/polygon.hpp"
#include "reference/discretisation/body_distances.hpp"
#include "reference/shapes.hpp"
#include "support/figures.hpp"
#include "support/random.hpp"

namespace pliant {
namespace {

using namespace testing;

/// A bar with notches of random depths from below and above, their corners on a lattice if wanted: many lie on one line
/// there, and one end often sees the other along an edge.
Points random_comb(testing::Random& random, bool on_lattice) {
  const auto number = [&](double low, double high) {
    const double x = random.uniform(low, high);
    return on_lattice ? std::round(x) : x;
  };
  Points lower{{0, 0}}, upper;
  const int teeth = 2 + random.below(5);
  for (int tooth = 0; tooth < teeth; ++tooth) {
    const double left = 4.0 * tooth, depth = number(0.6, 4.4), height = number(5, 9);
    lower.insert(lower.end(), {{left + 1, 0}, {left + 1, depth}, {left + 2, depth}, {left + 2, 0}});
    upper.insert(upper.end(), {{left + 2, 10}, {left + 2, height}, {left + 3, height}, {left + 3, 10}});
  }
  lower.emplace_back(4.0 * teeth, 0), upper.emplace_back(4.0 * teeth, 10);
  lower.insert(lower.end(), upper.rbegin(), upper.rend());
  return lower;
}

void compare_paths(const Points& outline, const Points& places, LargestFigures& figures) {
  const InnerPaths paths(outline);
  const reference::BodyDistances own(outline);
  for (const Vec2& from : places)
    for (const Vec2& to : places) {
      const double engine = paths.way(from, paths.triangle_at(from), to, paths.triangle_at(to)).norm();
      const double error = std::abs(engine - own.first_leg(from, to).length_from(from));
      EXPECT_LT(error, 1e-12 * (1 + engine)) << from.transpose() << " to " << to.transpose();
      figures.note("distances: through bodies", error / (1 + engine));
    }
}

// Outlines' own nodes, and places inside, on the lattice too. Rounding of lengths of up to 50.
TEST(ReferenceAgainstEngine, distances_through_bodies_agree) {
  LargestFigures figures;
  testing::Random random(7);
  for (int sample = 0; sample < 40; ++sample) {
    const bool on_lattice = sample % 2 == 0;
    const Points outline = random_comb(random, on_lattice);
    Points places = outline;
    while (places.size() < outline.size() + 12) {
      Vec2 x{random.uniform(0, 20), random.uniform(0, 10)};
      if (on_lattice) x = x.array().round();
      if (is_inside(outline, x) && distance_to_outline(outline, x) > 1e-3) places.push_back(x);
    }
    compare_paths(outline, places, figures);
  }
  for (const ShapeSpec& shape : {l_shape(120), fork(120), reference_shapes().back()}) {
    FieldMesh mesh = make_field_mesh(shape);
    const double unit = mean_node_distance(mesh);
    for (Vec2& x : mesh.nodes) x /= unit;
    compare_paths(outline_of(mesh), mesh.nodes, figures);
  }
}

}  // namespace
}  // namespace pliant
