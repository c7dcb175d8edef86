#pragma once

#include <Eigen/LU>

#include "geometry/cell.hpp"

namespace pliant {

/// The matrix with the columns a and b, in which x = matrix X of coordinates X that count periods.
inline Eigen::Matrix2d matrix_of(const Lattice& lattice) {
  Eigen::Matrix2d m;
  m << lattice.ax, lattice.bx, lattice.ay, lattice.by;
  return m;
}
inline Lattice lattice_of(const Eigen::Matrix2d& m) { return {m(0, 0), m(1, 0), m(0, 1), m(1, 1)}; }

inline double area_of(const Lattice& lattice) { return lattice.ax * lattice.by - lattice.ay * lattice.bx; }

/// Another basis of a lattice, and the images that its vectors lead to.
struct LatticeBasis {
  Lattice lattice;
  Images a{1, 0}, b{0, 1};
  /// Images of the given lattice.
  Images images(const Images& n) const { return {n.x * a.x + n.y * b.x, n.x * a.y + n.y * b.y}; }
};

/// Basis of shortest vectors (Gauss's reduction): a cell that is sheared without end has one of bounded tilt.
LatticeBasis shortest_basis(const Lattice& lattice);

/// The same lattice with b less the multiple of a that leaves its tilt within half of a: the cell as it is drawn.
LatticeBasis upright_basis(const Lattice& lattice);

}  // namespace pliant
