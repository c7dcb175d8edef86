#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <vector>

#include "reference/discretisation/space.hpp"
#include "reference/materials/energy.hpp"
#include "scene/scene.hpp"

namespace pliant::reference {

/// The step that viscosity acts over.
struct Increment {
  Eigen::VectorXd before;  ///< [2 nodes], positions at its start, m
  double duration = 0;     ///< s
};

/// Internal forces of one body at one state. Not numbers where some J <= 0, but for `linear_elastic`.
struct InternalState {
  double energy = 0;                    ///< elastic, J/m
  double dissipated = 0;                ///< by viscosity over the increment, J/m
  Eigen::VectorXd residual;             ///< [2 nodes], minus the forces, N/m
  Eigen::SparseMatrix<double> tangent;  ///< [2 nodes x 2 nodes] of the residual, symmetric; empty if not asked for
  double least_jacobian = 0;
  int least_point = 0;
};

/// What pictures show of an integration point. Cauchy stress, Pa; of `linear_elastic` that of small strains.
struct PointStress {
  double xx = 0, yy = 0, xy = 0, zz = 0;
  double jacobian = 1;
  double energy = 0;  ///< per reference volume, Pa
};

/// Internal forces of a body of some size, turned at the start, made of one material, from the shape's space of size 1.
/// Vectors [2 nodes] hold x and y of node 0, of node 1 and so on.
class InternalForces {
 public:
  InternalForces(const Space& space, const Material& material, double size, double angle);

  /// At positions q, m, from any origin. Viscosity acts only over an increment.
  InternalState evaluate(const Eigen::VectorXd& q, bool tangent,
                         const std::optional<Increment>& increment = std::nullopt) const;
  /// [points] Elastic stresses at positions q.
  std::vector<PointStress> stresses(const Eigen::VectorXd& q) const;
  /// [points], m2
  const Eigen::VectorXd& weights() const { return weight_; }

 private:
  /// From the unrotated start for `linear_elastic`, else as it is: the others do not see the initial rotation.
  template <class Scalar>
  Deformation<Scalar> measured(const Deformation<Scalar>& F) const;

  Material material_;
  double cos_, sin_;
  Eigen::VectorXd weight_;                ///< [points], m2
  Eigen::SparseMatrix<double> gradient_;  ///< [4 points x 2 nodes], F of each point from q: xx, xy, yx, yy; 1/m
};

}  // namespace pliant::reference
