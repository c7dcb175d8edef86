// Cost of the parts of one force evaluation on the headline scene, squeezed by a short run. One thread unless
// OMP_NUM_THREADS says otherwise.
//   ./pliant bench
#include <benchmark/benchmark.h>

#include "bodies/initial_state.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/place_outlines.hpp"
#include "dynamics/simulation.hpp"

namespace pliant {
namespace {

/// The full third body after a few hundred steps with a pressed-on wall.
Simulation& third_body() {
  static const Model model = [] {
    Scene scene = read_scene(PLIANT_SOURCE_DIR "/cases/third_body.toml");
    return build_model(scene);
  }();
  static Simulation simulation(model);
  if (simulation.state().steps == 0)
    while (simulation.state().steps < 300) simulation.step(1);
  return simulation;
}

void internal_forces(benchmark::State& state) {
  const Simulation& simulation = third_body();
  const Model& model = simulation.model();
  Dofs force = zero_dofs(model);
  for (auto _ : state)
    for (const Batch& batch : model.batches)
      benchmark::DoNotOptimize(add_internal_forces(model, batch,
                                                   {.position = &simulation.state().position.compliant[batch.offset]},
                                                   &force.compliant[batch.offset]));
}
BENCHMARK(internal_forces)->Unit(benchmark::kMillisecond);

void outlines(benchmark::State& state) {
  const Simulation& simulation = third_body();
  OutlineField place(simulation.model().outline_offset.back());
  for (auto _ : state) place_outlines(simulation.model(), simulation.state().position, place);
}
BENCHMARK(outlines)->Unit(benchmark::kMillisecond);

void contact_refresh(benchmark::State& state) {
  const Simulation& simulation = third_body();
  const Outlines& outlines = simulation.state().outlines;
  ContactSystem contact(simulation.model());
  ContactHistory history;
  for (auto _ : state) contact.find_candidates(outlines, history);
}
BENCHMARK(contact_refresh)->Unit(benchmark::kMillisecond);

void contact_forces(benchmark::State& state) {
  const Simulation& simulation = third_body();
  const Outlines& outlines = simulation.state().outlines;
  ContactSystem contact(simulation.model());
  ContactHistory committed, trial;
  OutlineField force;
  contact.find_candidates(outlines, committed);
  int nodes = 0;
  for (const Patch& patch : contact.patches()) nodes += patch.nodes[0].count + patch.nodes[1].count;
  state.counters["records"] = nodes;
  state.counters["patches"] = static_cast<double>(contact.patches().size());
  for (auto _ : state) state.counters["contacts"] = contact.forces(outlines, committed, trial, force).contacts;
}
BENCHMARK(contact_forces)->Unit(benchmark::kMillisecond);

void whole_evaluation(benchmark::State& state) {
  const Simulation& simulation = third_body();
  State now = simulation.state();
  now.memory = {};
  Forces forces(simulation.model());
  Trial trial(simulation.model());
  for (auto _ : state) evaluate_at(forces, now, trial);
}
BENCHMARK(whole_evaluation)->Unit(benchmark::kMillisecond);

void whole_step(benchmark::State& state) {
  Simulation& simulation = third_body();
  for (auto _ : state) simulation.step(1);
}
BENCHMARK(whole_step)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pliant

BENCHMARK_MAIN();
