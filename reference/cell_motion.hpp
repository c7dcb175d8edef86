#pragma once

#include <vector>

#include "reference/bodies.hpp"

namespace pliant::reference {

/// A cell with two periods between two times (docs/method.md 10), and what bodies do that follow it.
class CellMotion {
 public:
  /// From one time to another, s. In other domains nothing moves.
  CellMotion(const Scene& scene, double from, double until);

  /// Positions q after the motion if the centre of every body follows the cell, and the body moves along without being
  /// deformed or turned.
  Vector carried(const Bodies& bodies, const Vector& q) const;
  /// Bound of the displacement of one body's outline relative to that of another which it touches, when both are
  /// carried, m.
  double parting(const Bodies& bodies) const;
  /// Change of the vectors of the periods, m.
  Eigen::Matrix2d change() const { return change_; }

 private:
  Eigen::Matrix2d change_ = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d growth_ = Eigen::Matrix2d::Zero();  ///< displacement of matter that follows the cell by its position
};

/// Rate of the deformation gradient of a cell from a time on, 1/s.
Eigen::Matrix2d gradient_rate(const Scene& scene, double time);

/// Velocity gradient of a cell with a rate of its deformation gradient, 1/s; 0 in other domains.
Eigen::Matrix2d velocity_gradient(const Scene& scene, double time, const Eigen::Matrix2d& rate);

/// Velocities of matter with a velocity gradient, 1/s, at positions q: of the nodes of compliant bodies, and of the
/// centres of rigid ones, which turn by half of the curl.
Vector velocities_of_flow(const Bodies& bodies, const Vector& q, const Eigen::Matrix2d& gradient);

/// Centre of mass of a body at positions q, m.
Vec2 centre_of(const Bodies& bodies, const Body& body, const Vector& q);

/// Points of the histories of a cell, s.
std::vector<double> history_times_of_cell(const Scene& scene);

/// Degrees of freedom that keep the grains of a cell from moving as a whole: x and y of one node. As contacts alone act
/// in a cell, and their sum vanishes, they bear nothing. None in other domains.
std::vector<int> held_in_cell(const Bodies& bodies);

}  // namespace pliant::reference
