#pragma once

#include <vector>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bonds/bond_system.hpp"
#include "contact/history.hpp"
#include "core/lanes.hpp"
#include "dynamics/step_control.hpp"

namespace pliant {

/// Start for another run of the same bodies: motion and history variables at the end of a run. Forces, energies and the
/// energy balance follow from the other run's scene. It enumerates itself (core/archive.hpp).
struct StartPoint {
  StepControl control;
  Dofs position, reduced_momentum;  ///< as in State
  std::vector<Lanes> material;      ///< Memory::material
  InheritedContact contact;
  InheritedBonds bonds;

  template <class Visitor>
  void visit(Visitor&& visitor) {
    control.visit(visitor);
    visitor("position", position), visitor("reduced_momentum", reduced_momentum);
    visitor("cell", position.lattice), visitor("cell_rate", reduced_momentum.lattice);
    visitor("material", material), visitor("contact", contact), visitor("bonds", bonds);
  }
  /// Throws ArchiveError unless it fits the model's numbers of degrees of freedom and points.
  void require_fit(const Model& model) const;
};

}  // namespace pliant
