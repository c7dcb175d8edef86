#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>

#include "../geometry/shapes.hpp"
#include "discretisation/table.hpp"

namespace pliant {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;

// EXACT: the first ten elastic eigenfrequencies of a free disc, omega R/c_s at nu = 0.4, roots of Bessel functions;
// each is double (circumferential orders 2, 1, 3, 2, 4).
constexpr std::array<double, 5> exact{2.3510613358274024, 2.937116878885937, 3.631909643373923, 4.592731935277142,
                                      4.755312871846328};

struct ModeErrors {
  double oval, rms;  // relative
};

// Stiffness scaled by the masses, [2 nodes x 2 nodes]; mu = rho = 1, lambda = 4.
MatrixXd scaled_stiffness(const Discretisation& d) {
  const auto size = static_cast<Eigen::Index>(2 * d.mesh.nodes.size());
  MatrixXd k = MatrixXd::Zero(size, size);
  for (std::size_t g = 0; g < d.table.weight.size(); ++g)
    for (int a = d.table.start[g]; a < d.table.start[g + 1]; ++a)
      for (int b = d.table.start[g]; b < d.table.start[g + 1]; ++b) {
        const int i = d.table.node[a], j = d.table.node[b];
        const Vec2 &p = d.table.gradient[a], &q = d.table.gradient[b];
        const Matrix2d block = 4 * p * q.transpose() + q * p.transpose() + p.dot(q) * Matrix2d::Identity();
        k.block<2, 2>(2 * i, 2 * j) +=
            d.table.weight[g] / std::sqrt(d.mass_at_unit_density[i] * d.mass_at_unit_density[j]) * block;
      }
  return k;
}

// L^T K L with L L^T = D^1/2 C D^-1/2: the stiffness scaled by the corrected inverse mass C D^-1.
MatrixXd corrected(const Discretisation& d, const MatrixXd& stiffness) {
  MatrixXd c = MatrixXd::Zero(stiffness.rows(), stiffness.cols());
  for (int i = 0; i < static_cast<int>(d.mass_at_unit_density.size()); ++i)
    for (int e = d.reciprocal_mass.start[i]; e < d.reciprocal_mass.start[i + 1]; ++e) {
      const int j = d.reciprocal_mass.node[e];
      const double value =
          d.reciprocal_mass.value[e] * std::sqrt(d.mass_at_unit_density[i] / d.mass_at_unit_density[j]);
      c.block<2, 2>(2 * i, 2 * j) = value * Matrix2d::Identity();
    }
  const MatrixXd l = c.llt().matrixL();
  return l.transpose() * stiffness * l;
}

ModeErrors mode_errors(int nodes, const DiscretisationSettings& settings) {
  const Discretisation d = discretise(make_field_mesh(testing::disc(nodes, 2)), settings);
  const MatrixXd lumped = scaled_stiffness(d);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(settings.mass == Mass::corrected ? corrected(d, lumped) : lumped,
                                                      Eigen::EigenvaluesOnly);
  EXPECT_LT(std::abs(modes.eigenvalues()[2]), 1e-10);  // three rigid motions
  ModeErrors errors{std::sqrt(modes.eigenvalues()[3]) / exact[0] - 1, 0};
  for (int m = 0; m < 10; ++m) {
    const double error = std::sqrt(modes.eigenvalues()[3 + m]) / exact[static_cast<std::size_t>(m / 2)] - 1;
    errors.rms += error * error / 10;
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

void expect_errors(int nodes, const DiscretisationSettings& settings, double oval, double rms) {
  const ModeErrors errors = mode_errors(nodes, settings);
  EXPECT_NEAR(-errors.oval / oval, 1, 0.2) << fmt::format("oval {:.4f}", errors.oval);
  EXPECT_LT(errors.rms, 1.1 * rms) << fmt::format("rms {:.4f}", errors.rms);
}

// INDEPENDENT: errors of the prototype of docs/method.md 2 with lumped mass (oval mode and rms of ten), another mesh of
// as many nodes: the oval's within a fifth, the rms not a tenth above. A rim mode that moves hardly any material, as a
// mesh too coarse behind its outline has, would be among the ten and raise the rms to 20 %.
TEST(DiscModes, ErrorsAreThoseOfThePrototype) {
  expect_errors(168, {.method = DiscretisationMethod::mls, .support = 9}, 1.6e-2, 4.9e-2);
  expect_errors(168, {.method = DiscretisationMethod::mls_gauss, .support = 9, .gauss_points = 3}, 1.6e-2, 5.7e-2);
  expect_errors(700, {.method = DiscretisationMethod::mls, .support = 9}, 0.36e-2, 1.1e-2);
}

// INDEPENDENT: linear triangles with row-sum mass in the prototype of docs/method.md 2: oval 0.3 %, rms 1.1 %; too
// stiff and too heavy cancel. EXACT: smoothed over edges the stiffness is nearly right and what lumping does is seen:
// frequencies too low, yet less so than with moving least squares (rms 4.1 %), whose functions are wider.
TEST(DiscModes, Triangles) {
  const ModeErrors plain = mode_errors(168, {.method = DiscretisationMethod::t3}),
                   smoothed = mode_errors(168, {.method = DiscretisationMethod::es_t3});
  EXPECT_LT(std::abs(plain.oval), 0.3e-2);
  EXPECT_LT(plain.rms, 1.1 * 1.1e-2) << fmt::format("rms {:.4f}", plain.rms);
  EXPECT_LT(smoothed.oval, 0);
  EXPECT_LT(smoothed.rms, 0.041) << fmt::format("oval {:.4f}, rms {:.4f}", smoothed.oval, smoothed.rms);
}

// INDEPENDENT: the prototype of docs/method.md 2 with corrected mass, rms of the first ten modes: mls-gauss 0.9 %, mls
// 0.8 %, es-t3 0.10 % at 168 nodes, mls 0.06 % at 700; none of ours may be a fifth above on a mesh of its own. What is
// left of 4.9 % and 5.7 % shows that lumping was most of it.
TEST(DiscModes, CorrectedMass) {
  const auto rms = [](int nodes, DiscretisationSettings settings) {
    settings.mass = Mass::corrected;
    return mode_errors(nodes, settings).rms;
  };
  EXPECT_LT(rms(168, {.method = DiscretisationMethod::mls, .support = 9}), 1.2 * 0.8e-2);
  EXPECT_LT(rms(168, {.method = DiscretisationMethod::mls, .support = 8}), 1.2 * 0.8e-2);
  EXPECT_LT(rms(168, {.method = DiscretisationMethod::mls_gauss, .support = 9, .gauss_points = 3}), 1.2 * 0.9e-2);
  EXPECT_LT(rms(168, {.method = DiscretisationMethod::es_t3}), 1.2 * 0.10e-2);
  EXPECT_LT(rms(700, {.method = DiscretisationMethod::mls, .support = 9}), 1.2 * 0.06e-2);
}

// EXACT: C is symmetric under D, keeps constants, and its eigenvalues lie in [1, bound], bound <= 2.
TEST(ReciprocalMass, IsSymmetricKeepsMomentumAndIsBounded) {
  for (const DiscretisationMethod method : {DiscretisationMethod::mls, DiscretisationMethod::mls_gauss,
                                            DiscretisationMethod::t3, DiscretisationMethod::es_t3}) {
    const Discretisation d =
        discretise(make_field_mesh(testing::disc(84, 2)), {.method = method, .mass = Mass::corrected});
    const auto n = static_cast<Eigen::Index>(d.mesh.nodes.size());
    MatrixXd c = MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i)
      for (int e = d.reciprocal_mass.start[i]; e < d.reciprocal_mass.start[i + 1]; ++e)
        c(i, d.reciprocal_mass.node[e]) = d.reciprocal_mass.value[e];
    const Eigen::Map<const Eigen::VectorXd> mass(d.mass_at_unit_density.data(), n);
    const MatrixXd dc = mass.asDiagonal() * c;
    EXPECT_LT((dc - dc.transpose()).norm(), 1e-14 * dc.norm());
    EXPECT_LT((c.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-13);
    const MatrixXd scaled = mass.cwiseSqrt().asDiagonal() * c * mass.cwiseSqrt().cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(scaled, Eigen::EigenvaluesOnly);
    EXPECT_NEAR(eigen.eigenvalues()[0], 1, 1e-12);  // constants: the smallest, as D^-1 M has no eigenvalue above 1
    EXPECT_NEAR(eigen.eigenvalues()[n - 1], d.reciprocal_mass_bound, 1e-12);
    EXPECT_LE(d.reciprocal_mass_bound, 2);
  }
}

// EXACT: with a support of 8 no such mode is near for the smaller discs either; lumping makes all frequencies too low,
// by an error of order h^2: 84 nodes have twice that of 168 (4.1 %), so that 10 % leaves no room for a false mode.
TEST(DiscModes, SmallDiscsHaveNoFalseModesWithSupport8) {
  for (const int nodes : {84, 100, 130, 168, 250}) EXPECT_LT(mode_errors(nodes, {.support = 8}).rms, 0.1) << nodes;
}

/// Of the elastic modes of a free fork, the first two: prongs that bend apart, and in step.
std::array<double, 2> fork_modes(int nodes, double gap, const DiscretisationSettings& settings) {
  const MatrixXd stiffness = scaled_stiffness(discretise(make_field_mesh(testing::fork(nodes, gap)), settings));
  const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(stiffness, Eigen::EigenvaluesOnly);
  return {std::sqrt(modes.eigenvalues()[3]), std::sqrt(modes.eigenvalues()[4])};
}

// INDEPENDENT: linear triangles know nothing of supports. Gaps of 1, 1.5 and 2 node distances of 0.47. A method's own
// error is that with a gap of 4 node distances, which no support spans, for prongs that are thinner by a third there:
// 1.1 times that holds it, and twice that of `rpim`, which is not compatible and scatters from mesh to mesh. Triangles
// of half the node distance add a third of what halving it changes, at most 1 %. Supports across the gap give up to 7
// times the first frequency.
TEST(ForkModes, GapsOfANodeDistanceAreGaps) {
  std::array<std::array<double, 2>, 3> error{};
  for (const double gap : {1.88, 0.47, 0.7, 0.94}) {
    const std::array<double, 2> triangles = fork_modes(720, gap, {.method = DiscretisationMethod::es_t3});
    for (std::size_t method = 0; method < 3; ++method) {
      const DiscretisationMethod which =
          std::array{DiscretisationMethod::mls, DiscretisationMethod::mls_gauss, DiscretisationMethod::rpim}[method];
      const std::array<double, 2> own = fork_modes(180, gap, {.method = which});
      for (std::size_t mode = 0; mode < 2; ++mode) {
        const double found = std::abs(own[mode] / triangles[mode] - 1);
        if (gap == 1.88)
          EXPECT_LT(error[method][mode] = found, 0.05);
        else
          EXPECT_LT(found, (which == DiscretisationMethod::rpim ? 2 : 1.1) * error[method][mode] + 0.01)
              << "gap " << gap << ", " << method << ", mode " << mode;
      }
    }
  }
}

}  // namespace
}  // namespace pliant
