#include "core/elementary_functions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>

#include "support/random.hpp"

namespace pliant {
namespace {

using testing::Random;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Worst {
  double log = 0, root = 0;  // relative errors over epsilon
};

// Against long double functions, whose own error is 2^-11 of ours.
void compare(Lanes x, Worst& worst) {
  const Lanes log = natural_log(x), root = inverse_cube_root(x);
  for (int lane = 0; lane < lane_count; ++lane) {
    const long double value = x[lane], exact = std::log(value);
    const auto error = [](double found, long double wanted) {
      return static_cast<double>(std::abs((found - wanted) / wanted)) / epsilon;
    };
    if (exact != 0) worst.log = std::max(worst.log, error(log[lane], exact));
    worst.root = std::max(worst.root, error(root[lane], 1 / std::cbrt(value)));
  }
}

template <class Sample>
Worst worst_of(int count, Sample&& sample) {
  Worst worst;
  for (int i = 0; i < count; ++i) {
    Lanes x{};
    for (int lane = 0; lane < lane_count; ++lane) x[lane] = sample();
    compare(x, worst);
  }
  return worst;
}

// EXACT to the statement of the header, 6e-16 = 2.7 epsilon, for the logarithm. The root: two roundings of a product on
// top of that of the last Newton step give 2 epsilon.
void expect_accurate(const Worst& worst) {
  EXPECT_LT(worst.log * epsilon, 6e-16);
  EXPECT_LT(worst.root, 2);
  ::testing::Test::RecordProperty("log_eps", std::to_string(worst.log));
}

TEST(ElementaryFunctions, OverAllMagnitudes) {
  Random random(1);
  expect_accurate(worst_of(100000, [&] { return std::pow(10.0, random.uniform(-300, 300)); }));
}

TEST(ElementaryFunctions, AroundOne) {
  Random random(2);
  expect_accurate(worst_of(100000, [&] { return random.uniform(0.4, 2.5); }));
}

// Where ln x is small only a small absolute error keeps the relative one: Jacobians of stiff grains live here.
TEST(ElementaryFunctions, VeryNearOne) {
  Random random(3);
  expect_accurate(worst_of(100000, [&] {
    const double distance = std::pow(10.0, random.uniform(-15.5, -1));
    return random.below(2) ? 1 + distance : 1 - distance;
  }));
}

TEST(ElementaryFunctions, NextToPowersOfTwoAndTheirRoots) {
  Worst worst;
  for (int exponent = -1000; exponent <= 1000; ++exponent)
    for (const double base : {1.0, std::sqrt(0.5)}) {
      const double x = std::ldexp(base, exponent);
      compare(Lanes{x, std::nextafter(x, 0), std::nextafter(x, 1e308), x * 1.5, x * 1.1, x * 1.9, x * 1.41, x * 1.42},
              worst);
    }
  expect_accurate(worst);
}

// EXACT.
TEST(ElementaryFunctions, OfOneIsZero) {
  const Lanes log = natural_log(broadcast(1)), root = inverse_cube_root(broadcast(1));
  for (int lane = 0; lane < lane_count; ++lane) {
    EXPECT_EQ(log[lane], 0);
    EXPECT_EQ(root[lane], 1);
  }
}

// EXACT: no lane looks at another.
TEST(ElementaryFunctions, LanesAreIndependent) {
  const Lanes x = {1e-200, 0.3, 0.999999, 1, 1.0000001, 2.7, 1e5, 1e250};
  const Lanes logs = natural_log(x), roots = inverse_cube_root(x);
  for (int lane = 0; lane < lane_count; ++lane) {
    EXPECT_EQ(logs[lane], natural_log(broadcast(x[lane]))[0]);
    EXPECT_EQ(roots[lane], inverse_cube_root(broadcast(x[lane]))[0]);
  }
}

// EXACT: derivatives by complex step, d ln x = 1/x and d x^(-1/3) = -x^(-4/3)/3; a few roundings.
TEST(ElementaryFunctions, ComplexStep) {
  for (const double x : {0.2, 0.9, 1.7}) {
    const std::complex<double> step(x, 1e-30);
    EXPECT_NEAR(natural_log(step).imag() / 1e-30 * x, 1, 4 * epsilon);
    EXPECT_NEAR(inverse_cube_root(step).imag() / 1e-30 / (-std::pow(x, -4.0 / 3) / 3), 1, 8 * epsilon);
  }
}

/// Largest relative error of a function of lanes and of doubles, over samples of its argument.
template <class Function, class Exact, class Sample>
double worst_error(Function&& function, Exact&& exact, Sample&& sample) {
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    Lanes x{};
    for (int lane = 0; lane < lane_count; ++lane) x[lane] = sample(i * lane_count + lane);
    const Lanes y = function(x);
    for (int lane = 0; lane < lane_count; ++lane) {
      const long double wanted = exact(static_cast<long double>(x[lane]));
      for (const double found : {y[lane], function(x[lane])})
        worst = std::max(worst, static_cast<double>(std::abs((found - wanted) / wanted)));
    }
  }
  return worst;
}

// EXACT to the statement of the header.
TEST(ElementaryFunctions, Exponential) {
  Random random(3);
  const auto function = [](auto x) { return exponential(x); };
  const auto exact = [](long double x) { return std::exp(x); };
  EXPECT_LT(worst_error(function, exact, [&](int) { return random.uniform(-700, 700); }), 4e-16);
  EXPECT_LT(worst_error(function, exact, [&](int) { return random.uniform(-1, 1); }), 4e-16);
  EXPECT_EQ(exponential(broadcast(0))[3], 1);
}

// EXACT to the statement of the header, on both sides of the limit of the polynomial.
TEST(ElementaryFunctions, ExponentialOfSmall) {
  Random random(6);
  const auto function = [](auto x) { return exponential_of_small(x); };
  const auto exact = [](long double x) { return std::exp(x); };
  EXPECT_LT(worst_error(function, exact, [&](int) { return random.uniform(-1.0 / 256, 1.0 / 256); }), 4e-16);
  EXPECT_LT(worst_error(function, exact, [&](int) { return random.uniform(-2, 2); }), 4e-16);
}

/// Larger of the errors of both functions of hyperbolic(y^2) or hyperbolic_of_small(y^2), with y^2 up to a limit.
template <class Function>
double worst_of_hyperbolic(Function&& function, double limit) {
  Random random(4);
  const auto square = [&](int i) { return i == 0 ? 0 : limit * std::pow(10, random.uniform(-12, 0)); };
  const auto sinh_over = [&](auto y2) { return function(y2).sinh_over_y; };
  const auto cosh = [&](auto y2) { return function(y2).cosh; };
  return std::max(
      worst_error(
          sinh_over, [](long double y2) { return y2 == 0 ? 1 : std::sinh(std::sqrt(y2)) / std::sqrt(y2); }, square),
      worst_error(cosh, [](long double y2) { return std::cosh(std::sqrt(y2)); }, square));
}

// EXACT to the statement of the header, on both sides of the limit of the series.
TEST(ElementaryFunctions, Hyperbolic) {
  EXPECT_LT(worst_of_hyperbolic([](auto y2) { return hyperbolic(y2); }, 30), 2e-15);
}

// EXACT to the statement of the header, on both sides of the limit of the series.
TEST(ElementaryFunctions, HyperbolicOfSmall) {
  const auto function = [](auto y2) { return hyperbolic_of_small(y2); };
  EXPECT_LT(worst_of_hyperbolic(function, 1.0 / 65536), 4e-16);
  EXPECT_LT(worst_of_hyperbolic(function, 30), 2e-15);
}

// EXACT: two roundings of numbers of order one on top of the statement of the header.
TEST(ElementaryFunctions, TwiceArtanhOverSmall) {
  Random random(7);
  const auto function = [](auto s2) { return twice_artanh_over_small(s2); };
  const auto exact = [](long double s2) { return s2 == 0 ? 2 : 2 * std::atanh(std::sqrt(s2)) / std::sqrt(s2); };
  EXPECT_LT(worst_error(function, exact, [&](int i) { return i == 0 ? 0 : random.uniform(0, 0.02943); }), 2 * epsilon);
}

// EXACT to the statement of the header, on both sides of the limit of the series.
TEST(ElementaryFunctions, ArtanhOver) {
  Random random(5);
  const auto function = [](auto x) { return artanh_over(x); };
  const auto exact = [](long double z2) { return z2 == 0 ? 1 : std::atanh(std::sqrt(z2)) / std::sqrt(z2); };
  EXPECT_LT(worst_error(function, exact, [&](int i) { return i == 0 ? 0 : std::pow(10, random.uniform(-12, -1e-3)); }),
            4e-15);
}

}  // namespace
}  // namespace pliant
