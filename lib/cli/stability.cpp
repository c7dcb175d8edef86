#include "cli/stability.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "discretisation/mass.hpp"
#include "dynamics/time_step_bound.hpp"
#include "setup/build_model.hpp"

namespace pliant {
namespace {

constexpr double tried = 3;          ///< mass_scaling
constexpr double worth_while = 1.1;  ///< times as long
constexpr std::size_t most_bodies = 3000;

}  // namespace

Stability stability(const Model& model) {
  const Dofs position = initial_positions(model);
  Outlines outlines;
  update_outlines(model, {position, initial_velocities(model, position), 0}, outlines);
  ContactSystem contact(model);
  ContactHistory history;
  contact.find_candidates(outlines, history);
  TimeStepBound bound(model, contact.laws());
  bound.update_internal(position, initial_memory(model));
  BondSystem bonds(model, contact.laws());
  BondHistory bond_history;
  bonds.make(outlines.position, 0, bond_history);
  bound.update_contact(contact, bonds);
  return {bound.largest_dt(), bound.largest_dt(stiffer), bound.governing()};
}

double slowed_by_mass_scaling(const Model& model) {
  double largest = 1;
  if (model.scene.discretisation.mass_scaling > 1)
    for (const CompliantShape& shape : model.shapes)
      largest = std::max(
          largest, stretching_ratio(shape.space.mesh, shape.space.mass_at_unit_density, shape.space.reciprocal_mass));
  return std::sqrt(largest) - 1;
}

std::optional<std::string> advice_on_mass_scaling(const Model& model, const Stability& as_it_is) {
  const DiscretisationSettings& settings = model.scene.discretisation;
  if (settings.mass != Mass::lumped || settings.mass_scaling > 1 || model.groups.empty() ||
      model.bodies.size() > most_bodies || !std::isfinite(as_it_is.dt) ||
      !traits_of(model.scene.time.integrator).is_bounded)
    return {};
  Scene scene = model.scene;
  scene.discretisation.mass_scaling = tried;
  const Model scaled = build_model(scene);
  const double longer = stability(scaled).dt / as_it_is.dt;
  if (longer < worth_while) return {};
  return fmt::format(
      "mass_scaling = {:.0f} would make it {:.3g} times as long; compliant grains would stretch {:.2g} % more slowly; "
      "see docs/defaults.md",
      tried, longer, 100 * slowed_by_mass_scaling(scaled));
}

}  // namespace pliant
