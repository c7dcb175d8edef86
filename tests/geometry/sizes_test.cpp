#include "geometry/sizes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

SizeDistribution distribution(SizeDistribution::Kind kind, double low, double high, double centre = 1,
                              double deviation = 0) {
  return {kind, low, high, centre, deviation, {}, {}};
}

using Kind = SizeDistribution::Kind;

double mean_of(const std::vector<double>& sizes, double power) {
  double sum = 0;
  for (const double size : sizes) sum += std::pow(size, power);
  return sum / static_cast<double>(sizes.size());
}

// EXACT: moments of the distributions. Tolerance: quantiles of count n replace an integral by a midpoint rule; its
// error is below range^2/n, and 10/n^2 of it where the density is smooth at the limits.
TEST(Sizes, HaveTheMomentsOfTheirDistribution) {
  const std::vector<double> uniform = draw_sizes(distribution(Kind::uniform, 0.5, 1.5), 1000, 1);
  EXPECT_NEAR(mean_of(uniform, 1), 1, 1e-12);
  EXPECT_NEAR(mean_of(uniform, 2), 1 + 1.0 / 12, 1e-6);
  const std::vector<double> normal = draw_sizes(distribution(Kind::normal, 0.1, 1.9, 1, 0.15), 1000, 1);
  EXPECT_NEAR(mean_of(normal, 1), 1, 1e-6);
  EXPECT_NEAR(mean_of(normal, 2), 1 + 0.15 * 0.15, 1e-3 * 0.15 * 0.15 * 10);
  const std::vector<double> lognormal = draw_sizes(distribution(Kind::lognormal, 0.05, 20, 1, 0.2), 1000, 1);
  EXPECT_NEAR(mean_of(lognormal, 1), std::exp(0.02), 1e-4);
  EXPECT_NEAR(mean_of(lognormal, 2), std::exp(0.08), 1e-3);
}

// EXACT: shares of a list; a cut distribution stays within its limits, and half of a symmetric one lies below the mean.
TEST(Sizes, KeepToListsAndLimits) {
  SizeDistribution list;
  list.factors = {0.5, 2};
  list.shares = {0.75, 0.25};
  const std::vector<double> sizes = draw_sizes(list, 40, 3);
  EXPECT_EQ(std::count(sizes.begin(), sizes.end(), 0.5), 30);
  EXPECT_EQ(std::count(sizes.begin(), sizes.end(), 2.0), 10);
  const std::vector<double> cut = draw_sizes(distribution(Kind::normal, 0.9, 1.1, 1, 0.5), 100, 3);
  EXPECT_GE(*std::min_element(cut.begin(), cut.end()), 0.9);
  EXPECT_LE(*std::max_element(cut.begin(), cut.end()), 1.1);
  EXPECT_EQ(std::count_if(cut.begin(), cut.end(), [](double size) { return size < 1; }), 50);
}

// EXACT: a seed is an order; the sizes themselves are the same.
TEST(Sizes, SeedsShuffle) {
  const SizeDistribution uniform = distribution(Kind::uniform, 0.5, 1.5);
  std::vector<double> a = draw_sizes(uniform, 50, 1), b = draw_sizes(uniform, 50, 2);
  EXPECT_EQ(a, draw_sizes(uniform, 50, 1));
  EXPECT_NE(a, b);
  EXPECT_FALSE(std::is_sorted(a.begin(), a.end()));
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  EXPECT_EQ(a, b);
}

// EXACT: the mean of the square that gives the number of grains is that of the sizes drawn, and 1 without a
// distribution.
TEST(Sizes, MeanSquareIsThatOfTheDraw) {
  for (const SizeDistribution& one :
       {distribution(Kind::uniform, 0.5, 1.5), distribution(Kind::normal, 0.6, 1.2, 1, 0.3),
        distribution(Kind::lognormal, 0.6, 1.6, 1, 0.25), distribution(Kind::lognormal, 0.01, 100, 1, 0.01)})
    EXPECT_NEAR(mean_of(draw_sizes(one, 5000, 1), 2), mean_square_size(one), 1e-5);
  EXPECT_EQ(mean_square_size({}), 1);
}

}  // namespace
}  // namespace pliant
