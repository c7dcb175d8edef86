#pragma once

#include <vector>

#include "bodies/dofs.hpp"
#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"

namespace pliant {

/// Whether pressures or soft supports act on any outline.
bool has_outline_loads(const Model& model);

/// Adds the forces of pressures and soft supports on outline nodes, N/m, which reach the bodies as contact forces do.
/// `outlines`: of the motion, with its velocities if Model::outline_rates. Returns the power of the supports' dashpots,
/// W/m.
double add_outline_loads(const Model& model, const Instant& at, const Outlines& outlines, OutlineField& force);

/// Total force of pressures and supports on one body, N/m.
Vec2 outline_load(const Model& model, int body, const Outlines& outlines, const Instant& at);

/// Energy in the springs of soft supports, J/m.
double support_energy(const Model& model, const OutlineField& position, const Instant& at);

/// Part of add_load_change (boundary/loads.hpp) that acts on outlines: pressures and supports. Returns the increase of
/// the power of dashpots, W/m.
double add_outline_load_change(const Model& model, const Motion& at, const Outlines& outlines, const Instant& to,
                               Dofs& force);

/// Work of pressures, and of supports' histories on their springs and dashpots, in one step, J/m: trapezoidal rule.
double outline_work(const Model& model, const Outlines& before, const Instant& from, const Outlines& after,
                    const Instant& to);

}  // namespace pliant
