#pragma once

#include "reference/outputs/view.hpp"

namespace pliant::reference {

/// Stress of a cell with two periods, Pa, tension positive.
struct CellStress {
  /// Its virtual work is that of a homogeneous deformation of everything, the inside of bodies and the gaps between
  /// them. With the area A of the cell,
  ///   A contact = integral of the Cauchy stress over compliant bodies + sum over rigid bodies of force (x) arm
  ///               + sum over contacts and bonds of force (x) gap.
  /// In equilibrium it equals the sum of Love and Weber over forces and the vectors between centres, from which the
  /// engine takes it, but it uses neither these nor the periods. In motion the integral would include the inertia of
  /// the inside of bodies: forces and their arms from the centre of mass stand for it.
  Eigen::Matrix2d contact = Eigen::Matrix2d::Zero();
  /// Momentum that centres of mass carry relative to the motion of the cell.
  Eigen::Matrix2d kinetic = Eigen::Matrix2d::Zero();
};

CellStress cell_stress(const View& view);

}  // namespace pliant::reference
