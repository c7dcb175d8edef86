#pragma once

#include <vector>

#include "core/lanes.hpp"
#include "scene/instant.hpp"

namespace pliant {

/// One quantity over all degrees of freedom of a model: positions, velocities or forces.
struct Dofs {
  std::vector<Lanes> compliant;  ///< batch after batch: [nodes x 2 components] of its group
  std::vector<double> rigid;     ///< [rigid bodies x 3]: x, y, angle

  Dofs() = default;
  Dofs(std::size_t compliant_size, std::size_t rigid_size)
      : compliant(compliant_size, Lanes{}), rigid(rigid_size, 0.0) {}

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("compliant", compliant);
    visitor("rigid", rigid);
  }
};

/// Where all bodies are and how they move.
struct Motion {
  const Dofs& position;
  const Dofs& velocity;  ///< read only by models with forces that depend on it (Model::rates)
  double time = 0;       ///< s
  bool ends_step = false;
  Instant instant() const { return {time, ends_step}; }
};

}  // namespace pliant
