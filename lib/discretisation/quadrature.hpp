#pragma once

#include <array>

#include "geometry/mesh.hpp"

namespace pliant {

/// Point of a quadrature rule on a triangle: barycentric coordinates and share of the area.
struct QuadraturePoint {
  std::array<double, 3> barycentric;
  double share;
};

/// Symmetric rules of 1, 3 or 6 points, exact for polynomials of degree 1, 2 or 4 (Strang and Fix 1973; Dunavant 1985,
/// doi 10.1002/nme.1620210612). Throws InputError for any other number.
const std::vector<QuadraturePoint>& triangle_rule(int points);

/// Integration points of a whole mesh, triangle by triangle.
struct MeshQuadrature {
  Points position;             ///< [points]
  std::vector<double> weight;  ///< [points], area units of the mesh; sum to its area
  std::vector<int> triangle;   ///< [points]
};

MeshQuadrature mesh_quadrature(const FieldMesh& mesh, int points_per_triangle);

}  // namespace pliant
