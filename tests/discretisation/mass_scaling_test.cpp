// Selective mass scaling (docs/method.md 2): outline nodes share their accelerations with inner ones, for longer steps.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Eigenvalues>

#include "discretisation/mass.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double scaling = 3;

Scene scaled(Scene scene) {
  scene.discretisation.mass_scaling = scaling;
  return scene;
}

Discretisation scaled_mass_disc(int nodes, DiscretisationMethod method) {
  DiscretisationSettings settings;
  settings.method = method, settings.mass_scaling = scaling;
  return discretise(make_field_mesh(disc_shape("disc", 2, nodes)), settings);
}

Eigen::MatrixXd dense(const ShapeRows& rows) {
  const auto n = static_cast<Eigen::Index>(rows.start.size()) - 1;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (int e = rows.start[i]; e < rows.start[i + 1]; ++e) matrix(i, rows.node[e]) = rows.value[e];
  return matrix;
}

/// EXACT: M = D C^-1 is D plus (s - 1) m [1 -1; -1 1] between each outline node and the inner node nearest to it, which
/// in a disc is one across an edge. C has no negative entries.
TEST(MassScaling, couples_outline_nodes_to_the_nearest_inner_ones) {
  for (const DiscretisationMethod method : {DiscretisationMethod::mls, DiscretisationMethod::es_t3}) {
    const Discretisation space = scaled_mass_disc(90, method);
    const Eigen::MatrixXd c = dense(space.reciprocal_mass);
    EXPECT_GE(c.minCoeff(), 0);
    EXPECT_TRUE(space.reciprocal_mass_averages);
    const auto n = c.rows();
    const Eigen::VectorXd lumped = Eigen::Map<const Eigen::VectorXd>(space.mass_at_unit_density.data(), n);
    Eigen::MatrixXd expected = lumped.asDiagonal();
    for (Eigen::Index o = 0; o < space.mesh.outline_count; ++o) {
      Eigen::Index nearest = space.mesh.outline_count;
      for (Eigen::Index i = nearest; i < n; ++i)
        if ((space.mesh.nodes[i] - space.mesh.nodes[o]).norm() <
            (1 - 1e-9) * (space.mesh.nodes[nearest] - space.mesh.nodes[o]).norm())
          nearest = i;
      const double m = (scaling - 1) * lumped[o];
      expected(o, o) += m, expected(nearest, nearest) += m, expected(o, nearest) -= m, expected(nearest, o) -= m;
    }
    const Eigen::MatrixXd mass = lumped.asDiagonal() * c.inverse();
    EXPECT_LT((mass - expected).cwiseAbs().maxCoeff(), 1e-12 * lumped.maxCoeff());
    EXPECT_LT((mass.rowwise().sum() - lumped).cwiseAbs().maxCoeff(), 1e-12 * lumped.maxCoeff()) << "translation";
  }
}

/// EXACT: coupled nodes share an edge of the mesh, also beside a slit, across which other nodes are nearer.
TEST(MassScaling, stays_within_the_body) {
  ShapeSpec shape;
  shape.name = "slit", shape.kind = ShapeKind::curve, shape.nodes = 200;
  shape.points = {{-1, -1}, {1, -1}, {1, -0.02}, {-0.6, -0.02}, {-0.6, 0.02}, {1, 0.02}, {1, 1}, {-1, 1}};
  shape.outline_nodes = 80;
  DiscretisationSettings settings;
  settings.method = DiscretisationMethod::es_t3, settings.mass_scaling = scaling;
  const Discretisation space = discretise(make_field_mesh(shape), settings);
  const Eigen::MatrixXd c = dense(space.reciprocal_mass);
  std::set<std::pair<int, int>> edges;
  for (const Triangle& t : space.mesh.triangles)
    for (const int a : t)
      for (const int b : t) edges.insert({a, b});
  int pairs = 0;
  const auto inner = static_cast<Eigen::Index>(space.mesh.outline_count);
  for (Eigen::Index o = 0; o < inner; ++o)
    for (Eigen::Index i = inner; i < c.rows(); ++i)
      if (c(o, i) > 0) {
        ++pairs;
        EXPECT_TRUE(edges.contains({static_cast<int>(o), static_cast<int>(i)}));
      }
  EXPECT_GT(pairs, 40);
}

/// EXACT: the lumped mass and with it weight and momentum are what they were: a grain falls as without scaling.
TEST(MassScaling, lets_grains_fall_as_before) {
  Scene scene = empty_scene(1);
  scene.gravity = {0.3, -1};
  scene.shapes = {disc_shape("disc", 2, 90)};
  scene.grains.push_back(grains("disc", "disc", BodyKind::compliant, {{0, 0}}));
  const Model model = build_model(scaled(scene));
  Simulation simulation(model);
  advance(simulation, 1);
  const Vec2 velocity = mass_mean(model, model.bodies[0], simulation.state().reduced_momentum);
  EXPECT_LT((velocity - scene.gravity).norm(), 1e-12);
  const EnergyBalance audit = simulation.energy_balance();
  EXPECT_NEAR(audit.energy.kinetic / audit.energy.external_work, 1, 1e-10);
}

/// RATE: the coupling adds m h^2 |grad v|^2 to the kinetic energy of a rim of width h: a share of h^3 for smooth
/// velocities.
TEST(MassScaling, slows_smooth_motions_by_the_cube_of_the_node_distance) {
  const auto excess = [](int nodes) {
    const Discretisation space = scaled_mass_disc(nodes, DiscretisationMethod::t3);
    return stretching_ratio(space.mesh, space.mass_at_unit_density, space.reciprocal_mass) - 1;
  };
  const double coarse = excess(168), fine = excess(672);
  EXPECT_GT(fine, 0);
  EXPECT_NEAR(std::log2(coarse / fine), 3, 0.5) << "between meshes that are not similar";
}

/// INDEPENDENT: steps of a layer under contact are longer, by less than the root of the scaling.
TEST(MassScaling, allows_longer_steps) {
  const Scene scene = small_third_body(1);
  const Model plain = build_model(scene), with = build_model(scaled(scene));
  const double longer = Simulation(with).largest_dt() / Simulation(plain).largest_dt();
  EXPECT_GT(longer, 1.2);
  EXPECT_LT(longer, std::sqrt(scaling));
}

}  // namespace
}  // namespace pliant::dynamics_tests
