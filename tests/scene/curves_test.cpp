#include "scene/curves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "scene/polygon_rules.hpp"

namespace pliant {
namespace {

using std::numbers::pi;

// EXACT: areas and extents.
TEST(Curves, AreasAndExtents) {
  EXPECT_NEAR(signed_area(ellipse(3, 2)), pi * 1.5, 1e-12);
  EXPECT_NEAR(largest_extent(ellipse(3, 2)), 3, 3e-5);  // the polygon of equal area lies out by (pi/1440)^2/3 of it
  EXPECT_NEAR(signed_area(fourier_grain(2, {0.1, 0.2, 0.05}, 5)), pi, 1e-12);
  EXPECT_NEAR(signed_area(regular_polygon(6, 2)), 1.5 * std::sqrt(3), 1e-14);
}

// EXACT: the discrete Fourier transform of the polar radius gives the descriptors back, relative to the mean radius.
TEST(Curves, FourierGrainHasItsDescriptors) {
  const std::vector<double> descriptors{0.15, 0.08, 0.05, 0.03, 0.02, 0.01};
  const Points grain = fourier_grain(1e-6, descriptors, 11);
  const auto harmonic = [&](int n) {
    std::complex<double> sum = 0;
    for (const Vec2& p : grain) sum += p.norm() * std::polar(1.0, -n * std::atan2(p.y(), p.x()));
    return std::abs(sum) / static_cast<double>(grain.size());
  };
  const double mean = harmonic(0);
  EXPECT_NEAR(harmonic(1) / mean, 0, 1e-13);
  for (std::size_t i = 0; i < descriptors.size(); ++i)
    EXPECT_NEAR(2 * harmonic(static_cast<int>(i) + 2) / mean, descriptors[i], 1e-13);
  EXPECT_NEAR(harmonic(8) / mean, 0, 1e-13);
}

// EXACT: a seed is a grain; a radius that vanishes somewhere is none.
TEST(Curves, FourierGrainsDifferBySeed) {
  EXPECT_EQ(fourier_grain(1, {0.1, 0.1}, 1), fourier_grain(1, {0.1, 0.1}, 1));
  EXPECT_NE(fourier_grain(1, {0.1, 0.1}, 1), fourier_grain(1, {0.1, 0.1}, 2));
  EXPECT_TRUE(fourier_grain(1, {1.2}, 1).empty());
}

}  // namespace
}  // namespace pliant
