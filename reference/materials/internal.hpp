#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "reference/discretisation/space.hpp"
#include "reference/materials/energy.hpp"
#include "scene/scene.hpp"

namespace pliant::reference {

/// A Maxwell branch at one point: the inverse of the strain that its dashpot has taken up, and what that creeps
/// towards.
struct BranchPoint {
  Symmetric<double> viscous, goal;
};

/// Internal forces of one body at one state. Where some J <= 0 it has that alone.
struct InternalState {
  double energy = 0;                    ///< elastic, J/m
  Eigen::VectorXd residual;             ///< [2 nodes], minus the forces, N/m
  Eigen::SparseMatrix<double> tangent;  ///< [2 nodes x 2 nodes] of the residual, symmetric; empty if not asked for
  double least_jacobian = 0;
  int least_point = 0;
  double power = 0;                 ///< what Maxwell branches dissipate, W/m
  std::vector<BranchPoint> branch;  ///< [points] as they are then; empty without
};

/// Kelvin-Voigt damping of one body at one motion.
struct ViscousState {
  Eigen::VectorXd residual;  ///< [2 nodes], minus the forces, N/m
  /// [2 nodes x 2 nodes] of the residual by positions, unsymmetric, and by velocities; empty if not asked for.
  Eigen::SparseMatrix<double> by_positions, by_velocities;
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

  /// At positions q, m, from any origin, so long after what the points remember, s. Where that is infinite, branches
  /// have relaxed. With a branch the tangent is not symmetric.
  InternalState evaluate(const Eigen::VectorXd& q, bool tangent, double elapsed = 0) const;
  /// From then on the points remember this.
  void accept(std::vector<BranchPoint> branch) { branch_ = std::move(branch); }
  bool has_branch() const { return !branch_.empty(); }
  /// At positions q, m, and velocities v, m/s.
  ViscousState damping(const Eigen::VectorXd& q, const Eigen::VectorXd& v, bool tangent) const;
  /// [points] Elastic stresses at positions q.
  std::vector<PointStress> stresses(const Eigen::VectorXd& q) const;
  /// [points], m2
  const Eigen::VectorXd& weights() const { return weight_; }

 private:
  using Gradient = Eigen::Matrix<double, 4, Eigen::Dynamic>;

  /// F at one point from the coordinates of the nodes around it.
  struct PointGradient {
    Gradient gradient;       ///< [4 x coordinates], 1/m
    std::vector<int> place;  ///< [coordinates x coordinates] among the values of the tangent, column by column
  };
  PointGradient gradient_at(int point, const std::vector<int>& nodes) const;

  /// From the unrotated start for `linear_elastic`, else as it is: the others do not see the initial rotation.
  template <class Scalar>
  Deformation<Scalar> measured(const Deformation<Scalar>& F) const;

  /// Adds what the branch of a point does over some time, from its deformation on, to its stress, stiffness and energy
  /// by area.
  void add_branch(Eigen::Index point, const Deformation<double>& F, double elapsed, Eigen::Vector4d& stress,
                  Eigen::Matrix4d& stiffness, InternalState& state) const;

  /// [2 nodes x 2 nodes] of matrices [4 x 4] at the points, the entries (row, column) of F.
  Eigen::SparseMatrix<double> at_nodes(const std::vector<Eigen::Matrix4d>& of_points) const;

  Material material_;
  double cos_, sin_;
  std::vector<BranchPoint> branch_;       ///< [points] at the last accepted motion; empty without
  Eigen::VectorXd weight_;                ///< [points], m2
  Eigen::SparseMatrix<double> gradient_;  ///< [4 points x 2 nodes], F of each point from q: xx, xy, yx, yy; 1/m
  std::vector<PointGradient> at_point_;   ///< [points], the same
  Eigen::SparseMatrix<double> pattern_;   ///< [2 nodes x 2 nodes] zeros where the tangent may have entries
};

}  // namespace pliant::reference
