#pragma once

#include <functional>

#include "core/vec2.hpp"
#include "discretisation/table.hpp"

namespace pliant {

/// Shape functions that do not vanish at a point, and their gradients there.
struct ShapeFunctions {
  std::vector<int> node;      ///< [neighbours], ascending
  std::vector<double> value;  ///< [neighbours], sum to 1
  Points gradient;            ///< [neighbours], 1/length
  double condition = 1;       ///< estimated condition number of the system that they solve; 1 without one
};

/// Shape functions of a mesh, at a point of a given triangle: all that tables and masses need from a discretisation.
using Basis = std::function<ShapeFunctions(const Vec2& x, int triangle)>;

/// Shape functions of the scene's discretisation (`method`), on a mesh in mean node distances that must outlive them.
/// Throws InputError if the limits of the discretisation are exceeded.
Basis make_basis(const FieldMesh& mesh, const DiscretisationSettings& settings);

/// Linear shape functions of the mesh's triangles.
Basis linear_triangles(const FieldMesh& mesh);

/// Quality of the shape functions of a mesh at all points of evaluation.
struct BasisQuality {
  double least_value = 0;  ///< of phi: moving least squares are negative somewhere (docs/method.md 2)
  double condition = 1;    ///< largest condition number
};

/// The same basis, which records its quality in use. `quality` must outlive it.
Basis watched(const Basis& basis, BasisQuality& quality);

/// Values at all field nodes, one row each. Interpolating functions have one entry per row.
ShapeRows rows_at_nodes(const FieldMesh& mesh, const Basis& basis);

/// The rows of the outline nodes, which come first.
ShapeRows rows_at_outline(const FieldMesh& mesh, const ShapeRows& node_rows);

}  // namespace pliant
