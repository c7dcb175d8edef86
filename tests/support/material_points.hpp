#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstddef>

#include "materials/tensor.hpp"
#include "support/random.hpp"

/// What tests of laws of materials do at a point.
namespace pliant::testing {

using Complex = std::complex<double>;

constexpr double mu = 0.7, lambda = 2.1;                   ///< of elastic laws
constexpr double shear_modulus = 0.8, bulk_modulus = 1.9;  ///< of plastic ones
constexpr double tiny = 1e-30;                             ///< complex step: no cancellation
/// Of some hundred operations on numbers of order one.
constexpr double rounding_of_flow = 5e-14;

inline Tensor<double> random_deformation(Random& random, double size = 0.4) {
  return {1 + random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size),
          1 + random.uniform(-size, size)};
}

/// F with a step of one entry; entries in the order xx, xy, yx, yy.
inline Tensor<Complex> stepped(const Tensor<double>& F, std::size_t entry, Complex by = {0, tiny}) {
  Complex f[4] = {F.xx, F.xy, F.yx, F.yy};
  f[entry] += by;
  return {f[0], f[1], f[2], f[3]};
}

inline Tensor<double> turned(const Tensor<double>& F, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * F.xx - s * F.yx, c * F.xy - s * F.yy, s * F.xx + c * F.yx, s * F.xy + c * F.yy};
}

inline void expect_near(const Tensor<double>& a, const Tensor<double>& b, double error) {
  EXPECT_NEAR(a.xx, b.xx, error);
  EXPECT_NEAR(a.xy, b.xy, error);
  EXPECT_NEAR(a.yx, b.yx, error);
  EXPECT_NEAR(a.yy, b.yy, error);
}

}  // namespace pliant::testing
