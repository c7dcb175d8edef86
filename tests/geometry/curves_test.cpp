#include "geometry/curves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "geometry/polygon_rules.hpp"

namespace pliant {
namespace {

using std::numbers::pi;

/// What rounding makes of a polygon's area at most: its n terms are of the order of the area, as the origin lies inside
/// or on it; each product, and each of n sums of up to twice the area, errs by half a unit in the last place.
double rounding_of_area(const Points& polygon) {
  return 1.5 * static_cast<double>(polygon.size()) * std::numeric_limits<double>::epsilon() * signed_area(polygon);
}

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

// EXACT: a square with arcs has area a^2 - (4 - pi) r^2 and perimeter 4 a - (8 - 2 pi) r, to the (pi/1440)^2/6 of a
// chord; its points lie on the edges or at distance r from the corners' centres. With r = a/2 it is a circle.
TEST(Curves, RoundedSquare) {
  const Points square{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  const Points rounded = rounded_polygon(square, 0.3);
  EXPECT_NEAR(signed_area(rounded), 4 - (4 - pi) * 0.09, rounding_of_area(rounded));
  for (const Vec2& p : rounded) {
    const Vec2 beyond = ((p - Vec2(1, 1)).cwiseAbs() - Vec2(0.7, 0.7)).cwiseMax(0);
    EXPECT_NEAR(beyond.norm(), 0.3, 2e-6);
  }
  EXPECT_NEAR(largest_rounding(square), 1, 1e-15);
  EXPECT_TRUE(rounded_polygon(square, 1.01).empty());
  const Points circle = rounded_polygon(square, 1);
  EXPECT_EQ(polygon_defect(circle).text, "");
  EXPECT_NEAR(signed_area(circle), pi, rounding_of_area(circle));
}

// EXACT: five convex corners lose (1 - pi/4) r^2 each, the concave one gains it.
TEST(Curves, RoundedConcavePolygon) {
  const Points l_shape{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  const Points rounded = rounded_polygon(l_shape, 0.2);
  EXPECT_NEAR(signed_area(rounded), 3 - 4 * (1 - pi / 4) * 0.04, rounding_of_area(rounded));
  EXPECT_EQ(polygon_defect(rounded).text, "");
}

}  // namespace
}  // namespace pliant
