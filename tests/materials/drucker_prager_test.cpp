// Drucker-Prager plasticity: the return map of a point against three dimensions, Mohr and Coulomb's collapse, and its
// energy balance.
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

#include "materials/drucker_prager.hpp"
#include "support/material_points.hpp"

namespace pliant {
namespace {

using namespace testing;

using DruckerPragerRecord = DruckerPrager<double>::Record;
constexpr DruckerPragerRecord drucker_prager_virgin{1, 0, 1, 1, 0, 0, 0};
constexpr double friction = 0.9, dilatancy = 0.3, cohesion = 0.07, cone_hardening = 0.05;

template <class T = double>
DruckerPrager<T> drucker_prager_law(double along = dilatancy) {
  return {T{} + shear_modulus, T{} + bulk_modulus, T{} + friction, T{} + along, T{} + cohesion, T{} + cone_hardening};
}

DruckerPragerRecord random_drucker_prager_record(testing::Random& random) {
  DruckerPragerRecord record = drucker_prager_virgin;
  for (int i = 0; i < 3; ++i) {
    DruckerPragerRecord next;
    drucker_prager_law().over(1).respond(random_deformation(random, 0.25), record, next);
    record = next;
  }
  return record;
}

enum class Branch { elastic, cone, apex };

/// The law once more in three dimensions, by eigenvectors: the increment of flow by bisection of the yield function.
struct DruckerPragerInSpace {
  Eigen::Matrix3d tau, metric;
  double flow = 0;
  Branch branch = Branch::elastic;

  DruckerPragerInSpace(const Tensor<double>& F, const DruckerPragerRecord& old) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity(), C = f;
    f.topLeftCorner<2, 2>() << F.xx, F.xy, F.yx, F.yy;
    C.topLeftCorner<2, 2>() << old[0], old[1], old[1], old[2];
    C(2, 2) = old[3];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> b(f * C * f.transpose());
    const Eigen::Vector3d strain = 0.5 * b.eigenvalues().array().log();
    double volume = strain.sum();
    Eigen::Vector3d deviator = strain.array() - strain.mean();
    const double q = std::sqrt(6.0) * shear_modulus * deviator.norm(), strength = cohesion + cone_hardening * old[4];
    const auto on_cone = [&](double x) {
      return q - 3 * shear_modulus * x + friction * bulk_modulus * (volume - dilatancy * x) - strength -
             cone_hardening * x;
    };
    const auto on_apex = [&](double x) {
      return friction * bulk_modulus * (volume - friction * x) - strength - cone_hardening * x;
    };
    if (on_cone(0) > 0) {
      branch = on_cone(q / (3 * shear_modulus)) > 0 ? Branch::apex : Branch::cone;
      flow = branch == Branch::apex ? root(on_apex) : root(on_cone);
      deviator *= branch == Branch::apex ? 0 : 1 - 3 * shear_modulus * flow / q;
      volume -= flow * (branch == Branch::apex ? friction : dilatancy);
    }
    const Eigen::Matrix3d n = b.eigenvectors();
    tau =
        n * Eigen::Vector3d(bulk_modulus * volume + 2 * shear_modulus * deviator.array()).asDiagonal() * n.transpose();
    const Eigen::Vector3d elastic = (2 * (deviator.array() + volume / 3)).exp();
    metric = f.inverse() * n * elastic.asDiagonal() * n.transpose() * f.inverse().transpose();
  }
  static double root(const auto& function) {
    double low = 0, high = 10;
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      (function(middle) > 0 ? low : high) = middle;
    }
    return low;
  }
};

// EXACT: stress, plastic metric and flow of an increment against eigenvectors in three dimensions, on the cone and at
// its apex.
TEST(DruckerPrager, return_map_is_that_of_three_dimensions) {
  testing::Random random(1);
  int count[3] = {};
  for (int sample = 0; sample < 600; ++sample) {
    const DruckerPragerRecord old = sample < 20 ? drucker_prager_virgin : random_drucker_prager_record(random);
    const Tensor<double> F = random_deformation(random, sample % 3 == 0 ? 0.02 : 0.3);
    DruckerPragerRecord now;
    const Response<double> found = drucker_prager_law().over(0.5).respond(F, old, now);
    const DruckerPragerInSpace expected(F, old);
    ++count[static_cast<int>(expected.branch)];
    EXPECT_NEAR(now[4] - old[4], expected.flow, rounding_of_flow);
    EXPECT_NEAR(now[0], expected.metric(0, 0), 10 * rounding_of_flow);
    EXPECT_NEAR(now[1], expected.metric(0, 1), 10 * rounding_of_flow);
    EXPECT_NEAR(now[2], expected.metric(1, 1), 10 * rounding_of_flow);
    EXPECT_NEAR(now[3], expected.metric(2, 2), 10 * rounding_of_flow);
    EXPECT_NEAR(drucker_prager_law().sigma_zz(F, now) * found.J, expected.tau(2, 2), 10 * rounding_of_flow);
    EXPECT_NEAR(found.P.xx * F.xx + found.P.xy * F.xy, expected.tau(0, 0), 10 * rounding_of_flow);
    EXPECT_NEAR(found.P.xx * F.yx + found.P.xy * F.yy, expected.tau(0, 1), 10 * rounding_of_flow);
    EXPECT_NEAR(found.P.yx * F.yx + found.P.yy * F.yy, expected.tau(1, 1), 10 * rounding_of_flow);
  }
  for (const int branch : count) EXPECT_GT(branch, 50);
}

// EXACT: lanes on all branches give what each gives by itself.
TEST(DruckerPrager, lanes_agree_with_single_points) {
  testing::Random random(2);
  for (int sample = 0; sample < 50; ++sample) {
    Tensor<Lanes> F{};
    DruckerPrager<Lanes>::Record old, now;
    Tensor<double> points[lane_count];
    DruckerPragerRecord before[lane_count];
    for (int lane = 0; lane < lane_count; ++lane) {
      points[lane] = random_deformation(random, lane < 6 ? 0.3 : 0.01),
      before[lane] = lane < 6 ? random_drucker_prager_record(random) : drucker_prager_virgin;
      F.xx[lane] = points[lane].xx, F.xy[lane] = points[lane].xy;
      F.yx[lane] = points[lane].yx, F.yy[lane] = points[lane].yy;
      for (std::size_t k = 0; k < old.size(); ++k) old[k][lane] = before[lane][k];
    }
    const Response<Lanes> found = drucker_prager_law<Lanes>().over(0.4).weighted(broadcast(3)).respond(F, old, now);
    for (int lane = 0; lane < lane_count; ++lane) {
      DruckerPragerRecord single;
      const Response<double> expected =
          drucker_prager_law().over(0.4).weighted(3.0).respond(points[lane], before[lane], single);
      EXPECT_NEAR(found.P.xx[lane], expected.P.xx, 10 * rounding_of_flow);
      EXPECT_NEAR(found.P.xy[lane], expected.P.xy, 10 * rounding_of_flow);
      EXPECT_NEAR(found.P.yx[lane], expected.P.yx, 10 * rounding_of_flow);
      EXPECT_NEAR(found.P.yy[lane], expected.P.yy, 10 * rounding_of_flow);
      EXPECT_NEAR(found.loss[lane], expected.loss, 10 * rounding_of_flow);
      for (std::size_t k = 0; k < old.size(); ++k) EXPECT_NEAR(now[k][lane], single[k], 10 * rounding_of_flow);
    }
  }
}

// EXACT: a block compressed along x under a constant lateral stress -p in plane strain collapses at
// tau_xx = -(N p + 2 c sqrt N), N = tan^2(pi/4 + phi/2), as Mohr and Coulomb's law does: the match of both laws holds
// for associated flow where elastic strains no longer change. What changes still falls exponentially with the strain.
TEST(DruckerPrager, collapses_as_mohr_and_coulomb) {
  Material material;
  material.law = MaterialLaw::drucker_prager;
  material.young = 1, material.poisson = 0.3;
  material.friction_angle = material.dilatancy_angle = 0.5, material.cohesion = 1e-3;
  const auto matched = DruckerPrager<double>::of(material);
  const double p = 2e-3, N = std::pow(std::tan(0.25 * M_PI + 0.25), 2);
  const double expected = -(N * p + 2 * material.cohesion * std::sqrt(N));
  DruckerPragerRecord record = drucker_prager_virgin, now;
  double lateral = 0, axial_stress = 0;
  const int steps = 400;
  for (int k = 1; k <= steps; ++k) {
    const double axial = -0.08 * k / steps;
    const auto stress = [&](double strain) {
      const Tensor<double> F{std::exp(axial), 0, 0, std::exp(strain)};
      const Tensor<double> P = matched.over(1).respond(F, record, now).P;
      axial_stress = P.xx * F.xx;
      return P.yy * F.yy + p;
    };
    double low = lateral - 0.05, high = lateral + 0.05;  // the lateral stress grows with the lateral strain
    for (int i = 0; i < 60; ++i) {
      lateral = 0.5 * (low + high);
      (stress(lateral) < 0 ? low : high) = lateral;
    }
    stress(lateral);
    record = now;
  }
  EXPECT_NEAR(axial_stress, expected, 1e-6 * std::abs(expected));
}

// RATE: the work of the stress along a path is stored or dissipated but for the second order of steps, and dissipation
// is not negative, for flow with and without dilatancy.
TEST(DruckerPrager, work_is_stored_or_dissipated) {
  const auto path = [](double t) -> Tensor<double> {
    return {1 - 0.2 * std::sin(t), 0.25 * std::sin(2 * t), -0.1 * std::sin(t), 1 + 0.1 * std::sin(3 * t)};
  };
  const auto rate = [](double t) -> Tensor<double> {
    return {-0.2 * std::cos(t), 0.5 * std::cos(2 * t), -0.1 * std::cos(t), 0.3 * std::cos(3 * t)};
  };
  for (const double along : {0.0, dilatancy, friction}) {
    double errors[2];
    for (int i = 0; i < 2; ++i) {
      const int steps = 1000 << 4 * i;
      const double dt = 2.0 / steps;
      DruckerPragerRecord record = drucker_prager_virgin, next;
      double doing = 0, dissipated = 0, work = 0;
      for (int k = 1; k <= steps; ++k) {
        const auto response = drucker_prager_law(along).over(dt).respond(path(k * dt), record, next);
        EXPECT_GE(response.loss, 0);
        dissipated += response.loss;
        const Tensor<double> P = response.P, v = rate(k * dt);
        const double now = P.xx * v.xx + P.xy * v.xy + P.yx * v.yx + P.yy * v.yy;
        work += 0.5 * dt * (doing + now);
        doing = now, record = next;
      }
      EXPECT_GT(dissipated, 5e-3);
      errors[i] = std::abs(work - dissipated - drucker_prager_law().energy(path(2), record)) / dissipated;
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]) / 4, 2, 0.5) << errors[0] << " " << errors[1];
    EXPECT_LT(errors[1], 1e-5);
  }
}

}  // namespace
}  // namespace pliant
