#pragma once

#include <optional>
#include <vector>

#include "bonds/fragments.hpp"
#include "contact/contact_points.hpp"
#include "dynamics/simulation.hpp"

namespace pliant {

/// A simulation at one accepted state, as outputs see it. What is costly is found when it is first asked for, once.
class Snapshot {
 public:
  explicit Snapshot(Simulation& simulation) : simulation_(simulation) {}

  const Model& model() const { return simulation_.model(); }
  const State& state() const { return simulation_.state(); }
  const ContactSystem& contact() const { return simulation_.forces().contact(); }
  const BondSystem& bonds() const { return simulation_.forces().bonds(); }
  const OutlineField& outlines() const { return state().outlines.position; }   ///< m
  const OutlineField& contact_force() const { return state().contact_force; }  ///< on outline nodes, N/m

  Motion motion() const { return {state().position, velocities(), state().time}; }

  const std::vector<TouchingPair>& contacts() const;
  const std::vector<int>& contact_counts() const;  ///< [bodies] others that each touches; images count apiece
  const std::vector<Fragment>& fragments() const;
  const std::vector<int>& fragment_numbers() const;  ///< [bodies] -1 for walls
  const Dofs& velocities() const;                    ///< see bodies/reciprocal_mass.hpp
  const Dofs& accelerations() const;                 ///< total force over mass; imposed ones by their histories
  const Dofs& internal_forces() const;               ///< on compliant degrees of freedom, N/m
  const EnergyBalance& energy_balance() const;
  double balance_error() const { return simulation_.balance_error(energy_balance().energy); }

 private:
  Simulation& simulation_;
  mutable std::optional<std::vector<TouchingPair>> contacts_;
  mutable std::optional<std::vector<int>> contact_counts_;
  mutable std::optional<std::vector<Fragment>> fragments_;
  mutable std::optional<std::vector<int>> fragment_numbers_;
  mutable std::optional<Dofs> velocities_, accelerations_, internal_forces_;
  mutable std::optional<EnergyBalance> audit_;
};

}  // namespace pliant
