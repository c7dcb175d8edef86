#include "reference/discretisation/quadrature.hpp"

#include <cmath>

#include <fmt/format.h>

#include "core/errors.hpp"

namespace pliant::reference {
namespace {

/// Adds three points, one near or opposite each corner: coordinate 1 - 2 a there, a at the other two.
void add_orbit(std::vector<QuadraturePoint>& rule, double a, double share) {
  for (int corner = 0; corner < 3; ++corner) {
    Eigen::Vector3d place = Eigen::Vector3d::Constant(a);
    place[corner] = 1 - 2 * a;
    rule.push_back({place, share});
  }
}

}  // namespace

std::vector<QuadraturePoint> triangle_rule(int points) {
  std::vector<QuadraturePoint> rule;
  if (points == 1) rule.push_back({Eigen::Vector3d::Constant(1.0 / 3), 1});
  if (points == 3) add_orbit(rule, 1.0 / 6, 1.0 / 3);
  if (points == 6)
    for (double sign : {1.0, -1.0}) {
      const double a = (8 - std::sqrt(10.0) + sign * std::sqrt(38 - 44 * std::sqrt(0.4))) / 18;
      add_orbit(rule, a, (620 + sign * std::sqrt(213125 - 53320 * std::sqrt(10.0))) / 3720);
    }
  if (rule.empty()) throw InputError(fmt::format("{} Gauss points a triangle: 1, 3 or 6", points));
  return rule;
}

}  // namespace pliant::reference
