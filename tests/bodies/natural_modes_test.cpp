// Small motions from the kernels of a run: stiffness against the linear one of the table, inverse mass, frequencies,
// size and turn.
#include "bodies/natural_modes.hpp"

#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;

Scene resting_disc(int nodes, const DiscretisationSettings& settings, double angle = 0, double size = 1) {
  Scene scene = empty_scene(1e9);
  scene.discretisation = settings;
  scene.shapes = {disc_shape("disc", 2, nodes)};
  scene.grains = {grains("disc", "disc", BodyKind::compliant, {{0, 0}})};
  scene.grains[0].angle = angle;
  scene.grains[0].size.factors = {size};
  scene.contacts = {frictionless(1)};
  return scene;
}

/// Of small strains about the unturned start, mu = 1, lambda = 4, from the table alone.
MatrixXd linear_stiffness(const Discretisation& d) {
  const auto size = static_cast<Index>(2 * d.mesh.nodes.size());
  MatrixXd k = MatrixXd::Zero(size, size);
  for (std::size_t g = 0; g < d.table.weight.size(); ++g)
    for (int a = d.table.start[g]; a < d.table.start[g + 1]; ++a)
      for (int b = d.table.start[g]; b < d.table.start[g + 1]; ++b) {
        const Vec2 &p = d.table.gradient[a], &q = d.table.gradient[b];
        const Matrix2d block = 4 * p * q.transpose() + q * p.transpose() + p.dot(q) * Matrix2d::Identity();
        k.block<2, 2>(2 * d.table.node[a], 2 * d.table.node[b]) += d.table.weight[g] * block;
      }
  return k;
}

/// EXACT: differences of the kernel's forces; 1e-10 for their truncation and rounding.
TEST(NaturalModes, stiffness_is_the_linear_one_of_the_table) {
  for (const DiscretisationMethod method : {DiscretisationMethod::mls, DiscretisationMethod::mls_gauss,
                                            DiscretisationMethod::t3, DiscretisationMethod::es_t3}) {
    const Model model = build_model(resting_disc(61, {.method = method}));
    const MatrixXd exact = linear_stiffness(model.shapes[0].space),
                   found = small_motions(model, model.bodies[0]).stiffness;
    EXPECT_LT((found - exact).cwiseAbs().maxCoeff(), 1e-10 * exact.cwiseAbs().maxCoeff());
    EXPECT_LE(static_cast<double>((found.array() != 0).count()), 0.7 * static_cast<double>(found.size())) << "sparse";
  }
}

/// EXACT: an odd number of columns at the end, and rounding alone between sizes: w goes as 1 / size, turned or not.
TEST(NaturalModes, frequencies_go_with_the_size_and_not_with_the_angle) {
  for (const Mass mass : {Mass::lumped, Mass::corrected}) {
    const auto frequencies = [&](double angle, double size) {
      const Model model = build_model(resting_disc(61, {.mass = mass}, angle, size));
      return natural_modes(small_motions(model, model.bodies[0]));
    };
    const NaturalModes plain = frequencies(0, 1), other = frequencies(0.7, 0.5);
    EXPECT_EQ(plain.motions_at_rest, 3);
    ASSERT_EQ(plain.frequency.size(), 2 * 61 - 3);
    for (std::size_t i = 0; i < plain.frequency.size(); ++i)
      EXPECT_NEAR(other.frequency[i] / plain.frequency[i], 2, 1e-8) << i;
  }
}

/// EXACT: momentum m v of a rigid motion gives v everywhere, and unit momenta of all nodes the inverse of the lumped
/// mass with lumped mass.
TEST(NaturalModes, inverse_mass_keeps_rigid_motion) {
  for (const Mass mass : {Mass::lumped, Mass::corrected}) {
    const Model model = build_model(resting_disc(61, {.mass = mass}));
    const MatrixXd inverse = small_motions(model, model.bodies[0]).inverse_mass;
    const std::vector<double>& lumped = model.shapes[0].space.mass_at_unit_density;
    const Eigen::Map<const Eigen::VectorXd> masses(lumped.data(), static_cast<Index>(lumped.size()));
    EXPECT_LT((inverse * masses - Eigen::VectorXd::Ones(masses.size())).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(inverse.isDiagonal(0), mass == Mass::lumped);
  }
}

/// EXACT: two masses on a spring, w^2 = k (1/m1 + 1/m2); the other three motions have no stiffness.
TEST(NaturalModes, of_two_masses) {
  SmallMotions motions{MatrixXd::Zero(4, 4), MatrixXd::Zero(2, 2)};
  motions.stiffness(0, 0) = motions.stiffness(2, 2) = 3;
  motions.stiffness(0, 2) = motions.stiffness(2, 0) = -3;
  motions.inverse_mass.diagonal() << 1.0 / 2, 1.0 / 5;
  const NaturalModes modes = natural_modes(motions);
  EXPECT_EQ(modes.motions_at_rest, 3);
  ASSERT_EQ(modes.frequency.size(), 1);
  EXPECT_NEAR(modes.frequency[0], std::sqrt(3 * 0.7), 1e-14);
}

TEST(NaturalModes, too_many_nodes_are_refused) {
  const Model model = build_model(resting_disc(most_modal_nodes + 100, {.method = DiscretisationMethod::t3}));
  EXPECT_THROW(small_motions(model, model.bodies[0]), InputError);
}

}  // namespace
}  // namespace pliant::dynamics_tests
