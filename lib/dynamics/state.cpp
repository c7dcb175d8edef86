#include "dynamics/state.hpp"

#include <algorithm>

#include "core/archive.hpp"
#include "dynamics/body_heat.hpp"

namespace pliant {

Memory initial_memory(const Model& model) {
  Memory memory;
  memory.material.resize(model.material_memory);
  for (const Batch& batch : model.batches)
    with_law_type<Lanes>(model.groups[batch.group].law, [&]<class Law>(std::type_identity<Law>) {
      if constexpr (has_internal_variables<Law>)
        for (std::size_t k = 0; k < internal_variable_count<Law>; ++k)
          std::fill_n(&memory.material[batch.memory + k * static_cast<std::size_t>(batch.points)], batch.points,
                      broadcast(Law::internal_variables[k].initial));
    });
  if (tracks_heat(model.scene)) memory.heat.resize(model.bodies.size());
  return memory;
}

BatchMotion motion_of(const Batch& batch, const Dofs& position, const Memory& memory) {
  BatchMotion motion{.position = &position.compliant[batch.offset]};
  if (!memory.material.empty()) motion.memory = memory.material.data() + batch.memory;
  return motion;
}

std::uint64_t state_hash(const State& state) {
  HashLeaf leaf;
  const_cast<State&>(state).visit_motion(Walk(leaf));  // this leaf does not change it
  return leaf.hash.value();
}

}  // namespace pliant
