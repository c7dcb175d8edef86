#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <numbers>

#include "core/lanes.hpp"
#include "materials/with_law.hpp"
#include "support/material_points.hpp"

namespace pliant {
namespace {

using namespace testing;

/// A form of law, as a type that tests can be listed by.
template <template <class> class Law>
struct Form {
  template <class T>
  using law = Law<T>;
  template <class T>
  static Law<T> with(T m = mu, T l = lambda) {
    return {m, l};
  }
};

// docs/method.md 3 written down once more, in three dimensions: psi(diag(F, c)), from J and I1 of the whole.
template <class T>
T energy_3d(Form<NeoHookean>, T J, T I1) {
  return 0.5 * mu * (I1 - 3.0 - 2.0 * std::log(J)) + 0.5 * lambda * std::log(J) * std::log(J);
}
template <class T>
T energy_3d(Form<NeoHookeanQuadratic>, T J, T I1) {
  return 0.5 * mu * (I1 - 3.0 - 2.0 * std::log(J)) + 0.5 * lambda * (J - 1.0) * (J - 1.0);
}
template <class T>
T energy_3d(Form<Melody>, T J, T I1) {
  // K = E/(3(1 - 2 nu)) of the Lame constants.
  const double young = mu * (3 * lambda + 2 * mu) / (lambda + mu), poisson = lambda / (2 * (lambda + mu));
  const double bulk = young / (3 * (1 - 2 * poisson));
  return 0.5 * bulk * (J - 1.0) * (J - 1.0) + 0.5 * mu * (std::pow(J, -2.0 / 3) * I1 - 3.0);
}

template <class Law, class T>
T energy_3d(const Tensor<T>& F, T c) {
  const T in_plane = F.xx * F.yy - F.xy * F.yx;
  return energy_3d(Law{}, in_plane * c, F.xx * F.xx + F.xy * F.xy + F.yx * F.yx + F.yy * F.yy + c * c);
}

using Matrix = Eigen::Matrix2d;

Matrix as_matrix(const Tensor<double>& t) {
  Matrix m;
  m << t.xx, t.xy, t.yx, t.yy;
  return m;
}
Tensor<double> as_tensor(const Matrix& m) { return {m(0, 0), m(0, 1), m(1, 0), m(1, 1)}; }

Tensor<double> random_large_deformation(Random& random) {
  for (;;) {
    const Tensor<double> F{1 + random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),
                           1 + random.uniform(-0.5, 0.5)};
    if (determinant(F) > 0.2) return F;
  }
}

Matrix rotation(double angle) {
  Matrix Q;
  Q << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return Q;
}

template <class Law>
Matrix stress(const Matrix& F, double m = mu, double l = lambda) {
  return as_matrix(Law::template with<double>(m, l).respond(as_tensor(F)).P);
}

// Tangent dP_ij/dF_kl, 4 x 4.
template <class Law>
Eigen::Matrix4d tangent(const Tensor<double>& F) {
  Eigen::Matrix4d A;
  for (int kl = 0; kl < 4; ++kl) {
    const Tensor<Complex> P = Law::template with<Complex>().respond(stepped(F, kl)).P;
    A.col(kl) << P.xx.imag() / tiny, P.xy.imag() / tiny, P.yx.imag() / tiny, P.yy.imag() / tiny;
  }
  return A;
}

template <class Law>
class Materials : public ::testing::Test {};
using Laws = ::testing::Types<Form<NeoHookean>, Form<NeoHookeanQuadratic>, Form<Melody>>;
TYPED_TEST_SUITE(Materials, Laws);

// Rounding of some twenty operations on numbers of order one.
constexpr double rounding_of_laws = 1e-14;

// EXACT: P = dpsi/dF, with psi in three dimensions written anew above and its derivative by complex step.
TYPED_TEST(Materials, StressIsTheDerivativeOfTheEnergy) {
  Random random(1);
  for (int sample = 0; sample < 200; ++sample) {
    const Tensor<double> F = random_large_deformation(random);
    const Matrix P = stress<TypeParam>(as_matrix(F));
    for (int ij = 0; ij < 4; ++ij) {
      const double own = TypeParam::template with<Complex>().energy(stepped(F, ij)).imag() / tiny;
      const double anew = energy_3d<TypeParam, Complex>(stepped(F, ij), Complex(1)).imag() / tiny;
      EXPECT_NEAR(P(ij / 2, ij % 2), own, 10 * rounding_of_laws);
      EXPECT_NEAR(P(ij / 2, ij % 2), anew, 10 * rounding_of_laws);
    }
    EXPECT_NEAR(TypeParam::template with<double>().energy(F), (energy_3d<TypeParam, double>(F, 1.0)), rounding_of_laws);
    EXPECT_DOUBLE_EQ(TypeParam::template with<double>().respond(F).J, as_matrix(F).determinant());
  }
}

// EXACT: the out-of-plane Cauchy stress is (1/J) dpsi/dF33 at F33 = 1.
TYPED_TEST(Materials, OutOfPlaneStress) {
  Random random(2);
  for (int sample = 0; sample < 200; ++sample) {
    const Tensor<double> F = random_large_deformation(random);
    const Tensor<Complex> complex{F.xx, F.xy, F.yx, F.yy};
    const double derivative = energy_3d<TypeParam, Complex>(complex, Complex(1, tiny)).imag() / tiny;
    EXPECT_NEAR(TypeParam::template with<double>().sigma_zz(F), derivative / determinant(F), 10 * rounding_of_laws);
  }
}

// EXACT: P(QF) = Q P(F), isotropy P(FQ) = P(F) Q, a symmetric Cauchy stress, and no stress in a rotation.
TYPED_TEST(Materials, ObjectivityAndIsotropy) {
  Random random(3);
  for (int sample = 0; sample < 200; ++sample) {
    const Matrix F = as_matrix(random_large_deformation(random)), Q = rotation(random.uniform(0, 2 * std::numbers::pi));
    const Matrix P = stress<TypeParam>(F);
    EXPECT_LT((stress<TypeParam>(Q * F) - Q * P).norm(), 10 * rounding_of_laws);
    EXPECT_LT((stress<TypeParam>(F * Q) - P * Q).norm(), 10 * rounding_of_laws);
    const Matrix kirchhoff = P * F.transpose();
    EXPECT_NEAR(kirchhoff(0, 1), kirchhoff(1, 0), 10 * rounding_of_laws);
    EXPECT_NEAR(TypeParam::template with<double>().energy(as_tensor(Q * F)),
                TypeParam::template with<double>().energy(as_tensor(F)), rounding_of_laws);
    EXPECT_LT(stress<TypeParam>(Q).norm(), rounding_of_laws);
  }
}

// EXACT: second derivatives commute.
TYPED_TEST(Materials, TangentIsSymmetric) {
  Random random(4);
  for (int sample = 0; sample < 200; ++sample) {
    const Eigen::Matrix4d A = tangent<TypeParam>(random_large_deformation(random));
    EXPECT_LT((A - A.transpose()).norm(), 100 * rounding_of_laws);
  }
}

// EXACT: at F = I every law is Hooke's with the given mu and lambda, A = lambda I(x)I + mu (1 + transposition).
TYPED_TEST(Materials, HookeAtSmallStrain) {
  Eigen::Matrix4d hooke;
  hooke << lambda + 2 * mu, 0, 0, lambda, 0, mu, mu, 0, 0, mu, mu, 0, lambda, 0, 0, lambda + 2 * mu;
  EXPECT_LT((tangent<TypeParam>({1, 0, 0, 1}) - hooke).norm(), rounding_of_laws);
}

// A closed, smooth loop of large strains.
Matrix closed_loop(double s) {
  const double t = 2 * std::numbers::pi * s;
  Matrix F;
  F << 1.1 + 0.3 * std::cos(t), 0.3 * std::sin(t), -0.2 * std::sin(2 * t), 0.95 + 0.2 * std::sin(t);
  return F;
}
Matrix closed_loop_rate(double s) {
  const double w = 2 * std::numbers::pi, t = w * s;
  Matrix F;
  F << -0.3 * w * std::sin(t), 0.3 * w * std::cos(t), -0.4 * w * std::cos(2 * t), 0.2 * w * std::cos(t);
  return F;
}

// EXACT: a closed cycle returns the energy. The rectangle rule converges exponentially on a smooth periodic integrand:
// 400 points leave rounding only. The integral of |P:dF| is of order one.
TYPED_TEST(Materials, ClosedCycleReturnsTheEnergy) {
  constexpr int points = 400;
  double work = 0, magnitude = 0;
  for (int k = 0; k < points; ++k) {
    const double s = static_cast<double>(k) / points;
    const double power = stress<TypeParam>(closed_loop(s)).cwiseProduct(closed_loop_rate(s)).sum();
    work += power / points;
    magnitude += std::abs(power) / points;
  }
  EXPECT_GT(magnitude, 0.1);
  EXPECT_LT(std::abs(work) / magnitude, 1e-13);
}

// EXACT: with mu and lambda in another unit the stress is the same but for the unit.
TYPED_TEST(Materials, UnitsChangeNothing) {
  Random random(5);
  for (int sample = 0; sample < 50; ++sample) {
    const Matrix F = as_matrix(random_large_deformation(random));
    for (const double unit : {1e-9, 1e9})
      EXPECT_LT((stress<TypeParam>(F, unit * mu, unit * lambda) / unit - stress<TypeParam>(F)).norm(),
                10 * rounding_of_laws);
  }
}

// EXACT to the functions' 2 epsilon: eight lanes give what eight scalars give.
TYPED_TEST(Materials, LanesEqualScalars) {
  Random random(6);
  for (int sample = 0; sample < 50; ++sample) {
    Tensor<Lanes> F{};
    Tensor<double> scalar[lane_count];
    for (int lane = 0; lane < lane_count; ++lane) {
      scalar[lane] = random_large_deformation(random);
      F.xx[lane] = scalar[lane].xx, F.xy[lane] = scalar[lane].xy;
      F.yx[lane] = scalar[lane].yx, F.yy[lane] = scalar[lane].yy;
    }
    const Response<Lanes> response = TypeParam::with(broadcast(mu), broadcast(lambda)).respond(F);
    const Lanes energy = TypeParam::with(broadcast(mu), broadcast(lambda)).energy(F);
    for (int lane = 0; lane < lane_count; ++lane) {
      const Matrix P = stress<TypeParam>(as_matrix(scalar[lane]));
      EXPECT_NEAR(response.P.xx[lane], P(0, 0), rounding_of_laws);
      EXPECT_NEAR(response.P.xy[lane], P(0, 1), rounding_of_laws);
      EXPECT_NEAR(response.P.yx[lane], P(1, 0), rounding_of_laws);
      EXPECT_NEAR(response.P.yy[lane], P(1, 1), rounding_of_laws);
      EXPECT_NEAR(energy[lane], TypeParam::template with<double>().energy(scalar[lane]), rounding_of_laws);
    }
  }
}

// EXACT: the numbers of docs/method.md 3, mu = 1, lambda = 4; sixteen digits were given, 2e-15 is the last of them.
TEST(NeoHookeanOracle, StressAndEnergy) {
  const Tensor<double> F{1.2, 0.3, -0.1, 0.85};
  const Matrix P = as_matrix(NeoHookean<double>{1, 4}.respond(F).P);
  EXPECT_NEAR(P(0, 0), 0.5484633887391133, 2e-15);
  EXPECT_NEAR(P(0, 1), 0.2233486339693074, 2e-15);
  EXPECT_NEAR(P(1, 0), 0.1299540980920776, 2e-15);
  EXPECT_NEAR(P(1, 1), -0.0698163923683106, 2e-15);
  EXPECT_NEAR((NeoHookean<double>{1, 4}.energy(F)), 0.0872207960699283, 2e-15);
}

// EXACT: Lame constants of E and nu in three dimensions; E and nu come back.
TEST(ElasticConstants, LameConstants) {
  for (const double poisson : {0.0, 0.25, 0.4, 0.49}) {
    const LameConstants c = lame_constants(3, poisson);
    EXPECT_NEAR(c.mu * (3 * c.lambda + 2 * c.mu) / (c.lambda + c.mu), 3, 1e-14);
    EXPECT_NEAR(c.lambda / (2 * (c.lambda + c.mu)), poisson, 1e-15);
  }
}

// EXACT: each name gives its own law, of the material's constants, alone and in lanes.
TEST(WithLaw, ChoosesTheLaw) {
  const Tensor<double> F{1.3, 0.1, 0, 0.9};
  const auto energy = [&](MaterialLaw law, double expected) {
    Material material;
    material.law = law, material.young = 2.8, material.poisson = 0.4;  // mu = 1, lambda = 4
    EXPECT_NEAR(with_law(material, [&]<class Law>(const Law& l) { return energy_of(l, F, Record<Law, double>{}); }),
                expected, rounding_of_laws);
    LawConstants constants;
    for (int lane = 0; lane < lane_count; ++lane) {
      set_law_constants(material, lane, constants);
      material.young *= 2;
    }
    const Tensor<Lanes> in_lanes{broadcast(F.xx), broadcast(F.xy), broadcast(F.yx), broadcast(F.yy)};
    const Lanes found =
        with_law(law, constants, [&]<class Law>(const Law& l) { return energy_of(l, in_lanes, Record<Law>{}); });
    EXPECT_NEAR(found[0], expected, rounding_of_laws);
    EXPECT_NEAR(found[3], 8 * expected, 8 * rounding_of_laws);
  };
  energy(MaterialLaw::neo_hookean, NeoHookean<double>{1, 4}.energy(F));
  energy(MaterialLaw::neo_hookean_quadratic, NeoHookeanQuadratic<double>{1, 4}.energy(F));
  energy(MaterialLaw::melody, Melody<double>{1, 4}.energy(F));
  energy(MaterialLaw::linear_elastic, LinearElastic<double>{1, 4}.energy(F));
}

}  // namespace
}  // namespace pliant
