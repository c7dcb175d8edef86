#pragma once

#include <Eigen/Core>
#include <vector>

namespace pliant::reference {

/// Position in a triangle, barycentric, and its share of the area.
struct QuadraturePoint {
  Eigen::Vector3d place;
  double share = 0;
};

/// Symmetric Gauss rules of 1, 3 or 6 points, exact for polynomials of degree 1, 2 and 4 (Dunavant, Int. J. Numer.
/// Meth. Engng 21, 1985, 1129-1148, the last in closed form). Throws InputError for other numbers.
std::vector<QuadraturePoint> triangle_rule(int points);

}  // namespace pliant::reference
