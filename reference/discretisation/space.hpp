#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "geometry/mesh.hpp"
#include "scene/scene.hpp"

namespace pliant::reference {

/// Values of the shape functions at one position.
struct Row {
  std::vector<int> node;      ///< [neighbours], ascending
  std::vector<double> value;  ///< [neighbours]
};

/// Integration point: F = sum of q_i (x) gradient_i over its nodes.
struct Point {
  double weight = 0;           ///< m2
  std::vector<int> node;       ///< [neighbours], ascending
  Points gradient;             ///< [neighbours], 1/m
  std::vector<int> triangles;  ///< background triangles that it represents in pictures
};

/// Discretised shape: dense, slow, and independent of the engine's mathematics (docs/method.md 2).
struct Space {
  FieldMesh mesh;
  std::vector<Point> points;
  std::vector<Row> outline;                ///< [outline nodes]
  std::vector<Row> nodes;                  ///< [nodes]
  Eigen::VectorXd lumped;                  ///< [nodes], row sums of `consistent`, density 1, m2
  Eigen::SparseMatrix<double> consistent;  ///< [nodes x nodes], density 1, m2
};

/// Discretises a mesh as the scene says. Throws InputError for `rpim`, which this solver does not have, and for meshes
/// without a solution.
Space make_space(const FieldMesh& mesh, const DiscretisationSettings& settings);

}  // namespace pliant::reference
