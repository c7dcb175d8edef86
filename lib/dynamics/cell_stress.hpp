#pragma once

#include "bodies/model.hpp"
#include "dynamics/state.hpp"

namespace pliant {

/// Stress of a cell with two periods (docs/method.md 10), Pa, tension positive.
struct CellStress {
  /// Love and Weber: of each contact the force on one body times the vector from its centre to the other's.
  Eigen::Matrix2d contact = Eigen::Matrix2d::Zero();
  /// Momentum that centres of mass carry relative to the motion of the cell.
  Eigen::Matrix2d kinetic = Eigen::Matrix2d::Zero();
  /// Conjugate to the cell's velocity gradient in the work on images; without the mean inertia of the grains it is
  /// `contact`.
  Eigen::Matrix2d work = Eigen::Matrix2d::Zero();

  Eigen::Matrix2d total() const { return contact + kinetic; }
};

CellStress cell_stress(const Model& model, const State& state);

}  // namespace pliant
