#include "benchmarks/halo/unsupported.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "dynamics/body_heat.hpp"

namespace pliant::halo {

void refuse_unsupported(const Model& model) {
  const Scene& scene = model.scene;
  const bool drives_grains =
      std::ranges::any_of(model.driven, [&](int r) { return !model.bodies[model.rigid_bodies[r].body].wall; });
  const std::pair<bool, const char*> unsupported[] = {
      {scene.time.integrator != Integrator::verlet, "integrator \"step-doubling\""},
      {scene.cell.has_value(), "a cell with two periods"},
      {scene.contact.self_contact, "self-contact"},
      {scene.contact.refresh_steps > 0 || scene.contact.refresh_period > 0, "a fixed refresh interval"},
      {scene.contact.length == ContactLength::current, "current contact lengths"},
      {model.outline_rates, "dashpots"},
      {!model.pressures.empty() || !model.supports.empty() || drives_grains, "loads or conditions on grains"},
      {!scene.bonds.empty(), "bonds"},
      {tracks_heat(scene), "the rise of temperature"},
      {model.lane_batches < static_cast<int>(model.batches.size()),
       "compliant bodies that are alone in their batches; give 4 or more grains one shape"},
  };
  for (const auto& [is_used, name] : unsupported)
    if (is_used) throw InputError(fmt::format("{}: the halo prototype does not support {}", scene.file.string(), name));
}

}  // namespace pliant::halo
