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
  double condition = 1;       ///< estimate of the condition number of the system that they solve; 1 where there is none
};

/// The shape functions of a mesh, at a point of a given triangle: all that tables and masses need of a recipe.
using Basis = std::function<ShapeFunctions(const Vec2& x, int triangle)>;

/// The shape functions of the scene's recipe, on a mesh in mean node distances that must outlive them. Throws
/// InputError when the recipe's limits are exceeded.
Basis make_basis(const FieldMesh& mesh, const DiscretisationSettings& settings);

/// Linear functions of the mesh's triangles.
Basis linear_triangles(const FieldMesh& mesh);

/// What the shape functions of a mesh were like wherever they were asked for.
struct BasisQuality {
  double least_value = 0;  ///< of phi: moving least squares reach below zero (docs/method.md 2)
  double condition = 1;    ///< the largest
};

/// The same basis, which notes its quality as it is used. `quality` must outlive it.
Basis watched(const Basis& basis, BasisQuality& quality);

/// Values at all field nodes, one row each. Functions that interpolate have one entry a row.
ShapeRows rows_at_nodes(const FieldMesh& mesh, const Basis& basis);

/// The rows of the outline nodes, which come first.
ShapeRows rows_at_outline(const FieldMesh& mesh, const ShapeRows& node_rows);

}  // namespace pliant
