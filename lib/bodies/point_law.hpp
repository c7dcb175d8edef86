#pragma once

#include <algorithm>

#include "bodies/model.hpp"
#include "materials/kelvin_voigt.hpp"

namespace pliant {

/// Motion of the bodies of one batch, with the internal variables of their integration points.
struct BatchMotion {
  const Lanes* position = nullptr;  ///< [slots x 2]
  const Lanes* velocity = nullptr;  ///< likewise; null: no viscosity
  const Lanes* memory = nullptr;    ///< [variables x points], if the law has internal variables
  double elapsed = 0;               ///< time since `memory`, s; 0: they are held
  Lanes* new_memory = nullptr;      ///< likewise, after the motion; null: not needed
  bool elastic = true;              ///< false: only viscosity counts
  // Positions and forces of the next batch, prefetched meanwhile (core/prefetch.hpp), and the number of Lanes of each;
  // null: none.
  const Lanes *next_position = nullptr, *next_forces = nullptr;
  int next_count = 0;
};

/// Sums over the points of a batch's bodies, one body per lane.
struct PointTotals {
  Lanes least_jacobian = broadcast(1e300);
  Lanes power{};  ///< dissipated, for bodies of scale 1, W/m
  Lanes loss{};   ///< dissipated in the time increment, for bodies of scale 1, J/m
};

/// Calls action(law) with the response of a batch's points to a motion.
template <class Action>
auto with_point_law(const Model& model, const Batch& batch, const BatchMotion& motion, Action&& action) {
  if (!motion.elastic) return action(KelvinVoigt<Unresisting<Lanes>, Lanes>{{}, batch.viscosity});
  return with_law(model.groups[batch.group].law, batch.constants, [&]<class Law>(const Law& law) {
    if (!motion.velocity || !batch.viscous) return action(over(law, motion.elapsed));
    return action(over(KelvinVoigt<Law, Lanes>{law, batch.viscosity}, motion.elapsed));
  });
}

/// Internal variables of a point, or of eight points of a nodewise body. Without stored variables these are the initial
/// ones.
template <class Law>
Record<Law> load_record(const Batch& batch, const BatchMotion& motion, int point) {
  Record<Law> record;
  if constexpr (has_internal_variables<Law>)
    for (int k = 0; k < static_cast<int>(record.size()); ++k)
      record[k] =
          motion.memory ? motion.memory[k * batch.points + point] : broadcast(Law::internal_variables[k].initial);
  return record;
}
template <class Law>
void store_record(const Batch& batch, const BatchMotion& motion, int point, const Record<Law>& record) {
  if constexpr (has_internal_variables<Law>)
    if (motion.new_memory)
      for (int k = 0; k < static_cast<int>(record.size()); ++k) motion.new_memory[k * batch.points + point] = record[k];
}

}  // namespace pliant
