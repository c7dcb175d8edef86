// Rotational inertia of lumped and corrected masses over that of the polygon.
#include <gtest/gtest.h>

#include <cmath>

#include "discretisation/mass.hpp"
#include "discretisation/table.hpp"

namespace pliant {
namespace {

Discretisation disc_of_mass(int nodes, DiscretisationMethod method, Mass mass) {
  ShapeSpec shape;
  shape.name = "disc", shape.diameter = 2, shape.nodes = nodes;
  DiscretisationSettings settings;
  settings.method = method, settings.mass = mass;
  return discretise(make_field_mesh(shape), settings);
}

double ratio(const Discretisation& space) {
  return inertia_ratio(space.mesh, space.mass_at_unit_density, space.reciprocal_mass);
}

/// Row sums of linear triangles put a third of each triangle's mass on each of its corners.
TEST(InertiaRatio, is_that_of_thirds_on_corners) {
  const Discretisation space = disc_of_mass(60, DiscretisationMethod::t3, Mass::lumped);
  const Points& x = space.mesh.nodes;
  double thirds = 0, exact = 0;
  for (const Triangle& t : space.mesh.triangles) {
    const double area = 0.5 * cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]);
    const double squares = x[t[0]].squaredNorm() + x[t[1]].squaredNorm() + x[t[2]].squaredNorm();
    thirds += area / 3 * squares;
    exact += area / 12 * (squares + (x[t[0]] + x[t[1]] + x[t[2]]).squaredNorm());
  }
  EXPECT_NEAR(ratio(space), thirds / exact, 1e-12) << "EXACT";
}

/// E = D - M of a linear velocity is some h D near the outline and cancels inside. So lumping adds v.E v, of order h
/// times the rim's area h, and the correction leaves E v.D^-1 E v, of order h^2 times h.
TEST(InertiaRatio, excess_falls_with_the_node_distance) {
  for (const auto& [mass, order] : {std::pair(Mass::lumped, 2), std::pair(Mass::corrected, 3)}) {
    const double coarse = ratio(disc_of_mass(168, DiscretisationMethod::t3, mass)) - 1,
                 fine = ratio(disc_of_mass(672, DiscretisationMethod::t3, mass)) - 1;
    EXPECT_GT(fine, 0);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.5) << "RATE: between meshes that are not similar";
  }
}

TEST(InertiaRatio, of_the_default_method) {
  const double lumped[] = {6.8, 2.3, 0.53}, corrected[] = {0.49, 0.081, 0.0084};  // FROZEN, %
  const int nodes[] = {60, 168, 672};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(100 * (ratio(disc_of_mass(nodes[i], DiscretisationMethod::mls, Mass::lumped)) - 1), lumped[i], 0.05)
        << nodes[i];
    EXPECT_NEAR(100 * (ratio(disc_of_mass(nodes[i], DiscretisationMethod::mls, Mass::corrected)) - 1), corrected[i],
                5e-3)
        << nodes[i];
  }
}

}  // namespace
}  // namespace pliant
