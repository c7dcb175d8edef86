// Cost of the parts of one force evaluation on the headline scene, squeezed by a short run. One thread unless
// OMP_NUM_THREADS says otherwise.
//   ./pliant bench
// PLIANT_BENCH_FROM=DIR: a copy of the checkpoint of that run of any scene instead.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

#include "bodies/initial_state.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/place_outlines.hpp"
#include "dynamics/simulation.hpp"
#include "results/checkpoint.hpp"

namespace pliant {
namespace {

const std::optional<Checkpoint>& checkpoint() {
  static const std::optional<Checkpoint> found = []() -> std::optional<Checkpoint> {
    const char* folder = std::getenv("PLIANT_BENCH_FROM");
    if (!folder) return {};
    return Checkpoint(folder);
  }();
  return found;
}

/// The full third body after a few hundred steps with a pressed-on wall, or the checkpoint's scene and state.
Simulation& third_body() {
  static const Model model =
      build_model(read_scene(checkpoint() ? std::filesystem::path(std::getenv("PLIANT_BENCH_FROM")) / "scene.toml"
                                          : std::filesystem::path(PLIANT_SOURCE_DIR "/cases/third_body.toml")));
  static Simulation simulation(model);
  if (simulation.state().steps > 0) return simulation;
  if (checkpoint()) {
    const std::filesystem::path scratch = std::filesystem::temp_directory_path() / "pliant_bench";
    std::filesystem::remove_all(scratch);
    std::filesystem::copy(std::getenv("PLIANT_BENCH_FROM"), scratch);
    {
      Recorder recorder(model, scratch, true, Opening::resume);
      checkpoint()->restore(simulation, recorder);
    }
    std::filesystem::remove_all(scratch);
  }
  for (int i = 0; i < 300; ++i) simulation.step(1);
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
  contact.forces(outlines, committed, trial, force);
  std::swap(committed, trial);  // with slip
  int nodes = 0;
  for (const Patch& patch : contact.patches()) nodes += patch.nodes[0].count + patch.nodes[1].count;
  state.counters["records"] = nodes;
  state.counters["pairs"] = static_cast<double>(contact.patches().size());
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
