#pragma once

#include <array>
#include <vector>

#include "core/vec2.hpp"
#include "geometry/mesh.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Quadrature and gradient operator of internal forces (docs/method.md 2): a weight per integration point and a
/// reference gradient per neighbour node.
struct IntegrationTable {
  std::vector<double> weight;  ///< [points], m2; sum to the polygon's area
  std::vector<int> start;      ///< [points + 1], rows of `node` and `gradient`
  std::vector<int> node;       ///< [entries]
  Points gradient;             ///< [entries], 1/m
  /// [points], background triangles that a point represents in pictures: twice the one that contains it, or those
  /// at its edge.
  std::vector<std::array<int, 2>> cells;
};

/// Sparse rows phi_i(x_k): values of the shape functions at given points.
struct ShapeRows {
  std::vector<int> start;     ///< [rows + 1]
  std::vector<int> node;      ///< [entries]
  std::vector<double> value;  ///< [entries]
};

/// Discretised shape, shared by all of its grains.
struct Discretisation {
  FieldMesh mesh;
  IntegrationTable table;
  ShapeRows outline_rows;                    ///< at the outline nodes
  ShapeRows node_rows;                       ///< at all field nodes
  std::vector<double> mass_at_unit_density;  ///< [nodes], lumped mass at density 1, m2
  std::vector<double> nodal_distance;        ///< [nodes], distance to the nearest other node, m
  /// Rows of C, which takes p/D to velocities, D the lumped mass: 2 I - D^-1 M of corrected mass, or that of mass
  /// scaling (docs/method.md 2). Empty: C = I.
  ShapeRows reciprocal_mass;
  ShapeRows relative_mass;                ///< rows of C^-1 = D^-1 M of scaled mass; empty otherwise
  double reciprocal_mass_bound = 1;       ///< bound on its largest eigenvalue
  bool reciprocal_mass_averages = false;  ///< whether C has no negative entries
  double min_shape_value = 0;             ///< least phi at integration points and nodes (docs/method.md 2)
  double condition = 1;                   ///< largest condition number of the systems that the shape functions solve
  double completeness_residual = 0;       ///< `mls`: largest relative residual of conditions (1) and (2)
};

/// Discretises a mesh as the scene says. Throws InputError if the limits of the discretisation are exceeded.
Discretisation discretise(const FieldMesh& mesh, const DiscretisationSettings& settings);

}  // namespace pliant
