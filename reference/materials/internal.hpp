#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "reference/discretisation/space.hpp"
#include "reference/materials/energy.hpp"
#include "scene/scene.hpp"

namespace pliant::reference {

/// Internal forces of one body at one state. If some J <= 0, only the least J is set.
struct InternalState {
  double energy = 0;                    ///< elastic, J/m
  Eigen::VectorXd residual;             ///< [2 nodes], minus the forces, N/m
  Eigen::SparseMatrix<double> tangent;  ///< [2 nodes x 2 nodes] of the residual; empty unless requested
  double least_jacobian = 0;
  int least_point = 0;
  double power = 0;                   ///< dissipated by Maxwell branches, W/m
  double loss = 0;                    ///< dissipated by plastic flow in the increment, J/m
  std::vector<PointHistory> history;  ///< [points] updated; empty without internal variables
};

/// Kelvin-Voigt damping of one body at one motion.
struct ViscousState {
  Eigen::VectorXd residual;  ///< [2 nodes], minus the forces, N/m
  /// [2 nodes x 2 nodes] of the residual by positions, unsymmetric, and by velocities; empty unless requested.
  Eigen::SparseMatrix<double> by_positions, by_velocities;
};

/// Output of an integration point. Cauchy stress, Pa; for `linear_elastic` that of small strains.
struct PointStress {
  double xx = 0, yy = 0, xy = 0, zz = 0;
  double jacobian = 1;
  double energy = 0;  ///< per reference volume, Pa
  double plastic_strain = 0;
};

/// Internal forces of a body of given size and initial rotation, made of one material, from the shape's space of size
/// 1. Vectors [2 nodes] hold x and y of node 0, of node 1 and so on.
class InternalForces {
 public:
  InternalForces(const Space& space, const Material& material, double size, double angle);

  /// Internal forces at positions q, m, from any origin, after a time increment `elapsed`, s; if that is infinite,
  /// branches have relaxed, and plastic flow has no rate.
  InternalState evaluate(const Eigen::VectorXd& q, bool tangent, double elapsed = 0) const;
  /// Sets the internal variables of the points.
  void accept(std::vector<PointHistory> history) { history_ = std::move(history); }
  bool has_branch() const { return material_.law == MaterialLaw::neo_hookean_maxwell; }
  bool is_plastic() const {
    return material_.law == MaterialLaw::von_mises || material_.law == MaterialLaw::drucker_prager;
  }
  /// Whether forces are the gradient of a potential, so that the tangent is symmetric.
  bool has_potential() const { return !has_branch() && material_.law != MaterialLaw::drucker_prager; }
  const std::vector<PointHistory>& history() const { return history_; }
  /// Damping at positions q, m, and velocities v, m/s.
  ViscousState damping(const Eigen::VectorXd& q, const Eigen::VectorXd& v, bool tangent) const;
  /// [points] elastic stresses at positions q.
  std::vector<PointStress> stresses(const Eigen::VectorXd& q) const;
  /// [points], m2
  const Eigen::VectorXd& weights() const { return weight_; }

 private:
  using Gradient = Eigen::Matrix<double, 4, Eigen::Dynamic>;

  /// F at one point from the coordinates of its nodes.
  struct PointGradient {
    Gradient gradient;       ///< [4 x coordinates], 1/m
    std::vector<int> place;  ///< [coordinates x coordinates] indices in the values of the tangent, column by column
  };
  PointGradient gradient_at(int point, const std::vector<int>& nodes) const;

  /// F relative to the unrotated start for `linear_elastic`, else unchanged: other laws do not depend on the initial
  /// rotation.
  template <class Scalar>
  Deformation<Scalar> measured(const Deformation<Scalar>& F) const;

  /// Adds the response of the branch of a point over a time increment, from its deformation on, to its stress,
  /// stiffness and energy by area.
  void add_branch(Eigen::Index point, const Deformation<double>& F, double elapsed, Eigen::Vector4d& stress,
                  Eigen::Matrix4d& stiffness, InternalState& state) const;

  /// [2 nodes x 2 nodes] assembled from matrices [4 x 4] at the points, the entries (row, column) of F.
  Eigen::SparseMatrix<double> at_nodes(const std::vector<Eigen::Matrix4d>& of_points) const;

  Material material_;
  double cos_, sin_;
  std::vector<PointHistory> history_;     ///< [points] at the last accepted motion; empty without internal variables
  Eigen::VectorXd weight_;                ///< [points], m2
  Eigen::SparseMatrix<double> gradient_;  ///< [4 points x 2 nodes], F of each point from q: xx, xy, yx, yy; 1/m
  std::vector<PointGradient> at_point_;   ///< [points], the same
  Eigen::SparseMatrix<double> pattern_;   ///< [2 nodes x 2 nodes] zeros where the tangent may have entries
};

}  // namespace pliant::reference
