#pragma once

#include <array>
#include <vector>

#include "core/vec2.hpp"
#include "geometry/mesh.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Everything that internal forces need from space (docs/method.md 2): per integration point a weight and, for each
/// neighbour node, a reference gradient.
struct IntegrationTable {
  std::vector<double> weight;  ///< [points], m2; sum to the polygon's area
  std::vector<int> start;      ///< [points + 1], rows of `node` and `gradient`
  std::vector<int> node;       ///< [entries]
  Points gradient;             ///< [entries], 1/m
  /// [points], background triangles that a point stands for in pictures: twice the one it lies in, or those beside its
  /// edge.
  std::vector<std::array<int, 2>> cells;
};

/// Sparse rows phi_i(x_k): values of the shape functions at given points.
struct ShapeRows {
  std::vector<int> start;     ///< [rows + 1]
  std::vector<int> node;      ///< [entries]
  std::vector<double> value;  ///< [entries]
};

/// One shape, discretised: shared by all of its grains.
struct Discretisation {
  FieldMesh mesh;
  IntegrationTable table;
  ShapeRows outline_rows;                    ///< at the outline nodes
  ShapeRows node_rows;                       ///< at all field nodes
  std::vector<double> mass_at_unit_density;  ///< [nodes], lumped mass at density 1, m2
  std::vector<double> nodal_distance;        ///< [nodes], distance to the nearest other node, m
  /// Rows of 2 I - D^-1 M, D the lumped and M the consistent mass: from p/D to velocities (docs/method.md 2). Empty:
  /// lumped.
  ShapeRows mass_correction;
  double correction_bound = 1;       ///< on its largest eigenvalue
  double weight_share = 1;           ///< of the mass: what is left without that which rim_mass adds
  double min_shape_value = 0;        ///< least phi met at integration points and nodes (docs/method.md 2)
  double condition = 1;              ///< largest condition number of the systems that the shape functions solve
  double completeness_residual = 0;  ///< `mls`: largest relative residual of conditions (1) and (2)
};

/// Discretises a mesh by the scene's recipe. Throws InputError when the recipe's limits are exceeded.
Discretisation discretise(const FieldMesh& mesh, const DiscretisationSettings& settings);

}  // namespace pliant
