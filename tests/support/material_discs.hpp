#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "bodies/body_view.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/internal_forces.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

/// Discs of a material with internal variables.
namespace pliant::dynamics_tests {

/// A disc after three deformations, a tenth of a second apart.
struct DeformedDisc {
  Model model;
  Dofs position = initial_positions(model), force = zero_dofs(model);
  Memory memory = initial_memory(model);
  PointTotals totals;  ///< of the last one

  DeformedDisc(const Material& material, std::uint64_t seed, const BuildOptions& options)
      : model(build_model(scene_of(material), options)) {
    Random random(seed);
    for (int step = 0; step < 3; ++step) {
      move(random);
      add_forces();
    }
  }
  static Scene scene_of(const Material& material) {
    Scene scene = free_disc(60, 1);
    scene.materials[0] = material;
    return scene;
  }
  void move(Random& random) {
    const Body& body = model.bodies[0];
    for (int i = 0; i < model.shape_of(body).nodes(); ++i) {
      const auto node = static_cast<std::size_t>(i);
      const Vec2 x = BodyView(model, body, position)[node], noise{random.uniform(-1, 1), random.uniform(-1, 1)};
      set_node(BodyOffsets(model, body), node, x + 0.01 * noise + 0.05 * Vec2(x.y() * x.y(), x.x()), position);
    }
    fill_padding(model, position);
  }
  void add_forces() {
    const Batch& batch = model.batches[model.bodies[0].batch];
    Memory next = memory;
    BatchMotion motion = motion_of(batch, position, memory);
    motion.elapsed = 0.1, motion.new_memory = next.material.data() + batch.memory;
    force = zero_dofs(model);
    totals = add_internal_forces(model, batch, motion, &force.compliant[batch.offset]);
    memory = std::move(next);
  }
};

inline Scene oscillating_disc(const Material& material, Integrator integrator) {
  Scene scene = free_disc(60, 1e9, stretching(0.4));
  scene.materials[0] = material;
  scene.time.integrator = integrator;
  scene.time.tolerance = 1;
  return scene;
}

}  // namespace pliant::dynamics_tests
