#pragma once

#include "core/vec2.hpp"
#include "discretisation/table.hpp"

namespace pliant {

/// Shape functions that do not vanish at a point, and their gradients there.
struct ShapeFunctions {
  std::vector<int> node;      ///< [neighbours], ascending
  std::vector<double> value;  ///< [neighbours], sum to 1
  Points gradient;            ///< [neighbours], 1/length
};

/// Nodes with the radii of their supports: what moving least squares needs of a mesh.
struct MlsNodes {
  Points position;             ///< [nodes]
  std::vector<double> radius;  ///< [nodes]
};

/// Gives each node the distance to its support-th nearest other node as radius (METHOD 2). Throws InputError when there
/// are not that many nodes.
MlsNodes make_mls_nodes(const Points& nodes, int support);

/// Moving least squares at x: linear basis centred at x, cubic spline weight; the gradients are the full derivatives.
/// Lengths should be of the order of one node distance for good conditioning. Throws InputError when x has not three
/// neighbours off one line.
ShapeFunctions evaluate_mls(const MlsNodes& nodes, const Vec2& x);

/// Values at many points, one row each.
ShapeRows mls_rows(const MlsNodes& nodes, const Points& points);

}  // namespace pliant
