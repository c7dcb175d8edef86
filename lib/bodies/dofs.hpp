#pragma once

#include <vector>

#include "core/lanes.hpp"
#include "geometry/cell.hpp"
#include "scene/instant.hpp"

namespace pliant {

/// One quantity at all degrees of freedom of a model: positions, velocities or forces.
struct Dofs {
  std::vector<Lanes> compliant;  ///< batch after batch: [slots x 2 components]
  std::vector<double> rigid;     ///< [rigid bodies x 3]: x, y, angle
  Lattice lattice;               ///< of the images; the state of a cell with two periods has its own member for it

  Dofs() = default;
  Dofs(std::size_t compliant_size, std::size_t rigid_size)
      : compliant(compliant_size, Lanes{}), rigid(rigid_size, 0.0) {}

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("compliant", compliant);
    visitor("rigid", rigid);
  }
};

/// Positions and velocities of all bodies.
struct Motion {
  const Dofs& position;
  const Dofs& velocity;  ///< read only in models with forces that depend on it (Model::rates)
  double time = 0;       ///< s
  bool ends_step = false;
  Instant instant() const { return {time, ends_step}; }
};

}  // namespace pliant
