#include "scene/curves.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "scene/polygon_rules.hpp"

namespace pliant {
namespace {

using std::numbers::pi;

Points scaled_to_area(Points polygon, double area) {
  const double scale = std::sqrt(area / signed_area(polygon));
  for (Vec2& p : polygon) p *= scale;
  return polygon;
}

}  // namespace

Points regular_polygon(int sides, double diameter) {
  Points points;
  for (int k = 0; k < sides; ++k)
    points.emplace_back(diameter / 2 * std::cos(2 * pi * k / sides), diameter / 2 * std::sin(2 * pi * k / sides));
  return points;
}

Points ellipse(double width, double height) {
  Points points;
  for (const Vec2& p : regular_polygon(curve_points, 2)) points.emplace_back(width / 2 * p.x(), height / 2 * p.y());
  return scaled_to_area(points, pi / 4 * width * height);
}

Points fourier_grain(double diameter, const std::vector<double>& descriptors, std::int64_t seed) {
  // The engine's bits, not a library's distribution: the same grain on every machine.
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  std::vector<double> phases;
  for (std::size_t n = 0; n < descriptors.size(); ++n)
    phases.push_back(2 * pi * static_cast<double>(random() >> 11) * 0x1p-53);
  Points points;
  for (int k = 0; k < curve_points; ++k) {
    const double theta = 2 * pi * k / curve_points;
    double radius = 1;
    for (std::size_t i = 0; i < descriptors.size(); ++i)
      radius += descriptors[i] * std::cos(static_cast<double>(i + 2) * theta + phases[i]);
    if (!(radius > 0)) return {};
    points.emplace_back(radius * std::cos(theta), radius * std::sin(theta));
  }
  return scaled_to_area(points, pi / 4 * diameter * diameter);
}

}  // namespace pliant
