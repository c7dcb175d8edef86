#pragma once

#include <algorithm>

#include "bodies/model.hpp"
#include "materials/kelvin_voigt.hpp"

namespace pliant {

/// How the bodies of one batch stand and move, and what their integration points remember.
struct BatchMotion {
  const Lanes* position = nullptr;  ///< [slots x 2]
  const Lanes* velocity = nullptr;  ///< likewise; without, viscosity does not count
  const Lanes* memory = nullptr;    ///< [fields x points], of laws that remember
  double elapsed = 0;               ///< since then, s
  Lanes* new_memory = nullptr;      ///< likewise, where it is wanted
  bool elastic = true;              ///< false: viscosity alone counts
  // Positions and forces of the batch whose turn is next, asked for on the way (core/prefetch.hpp), and how many Lanes
  // of each; null: none.
  const Lanes *next_position = nullptr, *next_forces = nullptr;
  int next_count = 0;
};

/// What the points of a batch's bodies add up to, a lane a body.
struct PointTotals {
  Lanes least_jacobian = broadcast(1e300);
  Lanes power{};  ///< dissipated, of bodies of scale 1, W/m
};

/// Calls action(law) with what the points of a batch answer to a motion.
template <class Action>
auto with_point_law(const Model& model, const Batch& batch, const BatchMotion& motion, Action&& action) {
  if (!motion.elastic) return action(KelvinVoigt<Unresisting<Lanes>, Lanes>{{}, batch.viscosity});
  return with_law(model.groups[batch.group].law, batch.constants, [&]<class Law>(const Law& law) {
    if (!motion.velocity || !batch.viscous) return action(over(law, motion.elapsed));
    return action(over(KelvinVoigt<Law, Lanes>{law, batch.viscosity}, motion.elapsed));
  });
}

/// What the law remembers of a point, or of eight of a spread body. A motion without memory is at its start.
template <class Law>
Record<Law> load_record(const Batch& batch, const BatchMotion& motion, int point) {
  Record<Law> record;
  if constexpr (has_internal_variables<Law>)
    for (int k = 0; k < static_cast<int>(record.size()); ++k)
      record[k] =
          motion.memory ? motion.memory[k * batch.points + point] : broadcast(Law::internal_variables[k].at_first);
  return record;
}
template <class Law>
void store_record(const Batch& batch, const BatchMotion& motion, int point, const Record<Law>& record) {
  if constexpr (has_internal_variables<Law>)
    if (motion.new_memory)
      for (int k = 0; k < static_cast<int>(record.size()); ++k) motion.new_memory[k * batch.points + point] = record[k];
}

}  // namespace pliant
