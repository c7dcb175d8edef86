// Kernels of compliant bodies: internal forces of all methods and layouts, the integrator's update, outlines, and a
// step of grains that touch nothing.
#include <vector>

#include "benchmarks/baseline/from_model.hpp"
#include "benchmarks/kernels/meter.hpp"
#include "benchmarks/kernels/scenes.hpp"
#include "benchmarks/kernels/work.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/place_outlines.hpp"
#include "core/parallel.hpp"

namespace pliant::kernels {
namespace {

constexpr double dt = 1e-15;  ///< so short that what the plain loops move stays where it is

Cloud& mls() { return grains_of(DiscretisationMethod::mls); }
Cloud& mls_gauss() { return grains_of(DiscretisationMethod::mls_gauss); }
Cloud& es_t3() { return grains_of(DiscretisationMethod::es_t3); }
Cloud& t3() { return grains_of(DiscretisationMethod::t3); }

/// Batches of lanes are shared out as in a step; of a nodewise body its parts are.
void add_all(const Model& model, const Dofs& position, Dofs& force) {
  const auto add = [&](int b) {
    const Batch& batch = model.batches[b];
    benchmark::DoNotOptimize(add_internal_forces(model, batch, {.position = &position.compliant[batch.offset]},
                                                 &force.compliant[batch.offset]));
  };
  if (model.lane_batches > 0) parallel_for(model.lane_batches, add);
  for (int b = model.lane_batches; b < static_cast<int>(model.batches.size()); ++b) add(b);
}

void internal_forces(benchmark::State& state, Cloud& (*cloud)()) {
  const Cloud& grains = cloud();
  const Threads threads(state);
  Dofs force = zero_dofs(grains.model);
  for (auto _ : state) add_all(grains.model, grains.state.position, force);
  report(state, "point", integration_points(grains.model), work::internal_forces(grains.model));
}
#define INTERNAL_FORCES(scene, name) \
  BENCHMARK_CAPTURE(internal_forces, scene, scene)->Name("internal_forces/" name)->Apply(one_and_two_threads)
INTERNAL_FORCES(mls, "mls");
INTERNAL_FORCES(mls_gauss, "mls-gauss");
INTERNAL_FORCES(es_t3, "es-t3");
INTERNAL_FORCES(t3, "t3");
INTERNAL_FORCES(same_topology, "mls-same-topology");
INTERNAL_FORCES(large_body, "mls-nodewise");

Cloud& neo_hookean() { return grains_with(MaterialLaw::neo_hookean); }
Cloud& maxwell() { return grains_with(MaterialLaw::neo_hookean_maxwell); }
Cloud& von_mises_elastic() { return grains_with(MaterialLaw::von_mises, 1e12); }
Cloud& von_mises_flowing() { return grains_with(MaterialLaw::von_mises, 1e6); }
Cloud& drucker_prager_flowing() { return grains_with(MaterialLaw::drucker_prager, 1e5); }

/// Internal forces of a time increment after a larger one, 1e-4 of the strain further on: points that flow do so by
/// little, as in a step.
void law_of_points(benchmark::State& state, Cloud& (*cloud)()) {
  const Cloud& grains = cloud();
  const Model& model = grains.model;
  const Threads threads(state);
  Dofs force = zero_dofs(model);
  Dofs position = initial_positions(model);
  for (std::size_t i = 0; i < position.compliant.size(); ++i)
    position.compliant[i] += (1 - 1e-4) * (grains.state.position.compliant[i] - position.compliant[i]);
  Memory before = grains.state.memory, trial = before;
  const auto evaluate = [&](const Dofs& at, const Memory& from, Memory& to) {
    parallel_for(model.lane_batches, [&](int b) {
      const Batch& batch = model.batches[b];
      BatchMotion motion = motion_of(batch, at, from);
      motion.elapsed = dt;
      if (motion.memory) motion.new_memory = to.material.data() + batch.memory;
      benchmark::DoNotOptimize(add_internal_forces(model, batch, motion, &force.compliant[batch.offset]));
    });
  };
  evaluate(position, before, before);
  for (auto _ : state) evaluate(grains.state.position, before, trial);
  report(state, "point", integration_points(model), work::internal_forces(model));
}
#define LAW_OF_POINTS(scene, name) \
  BENCHMARK_CAPTURE(law_of_points, scene, scene)->Name("law/" name)->Apply(one_and_two_threads)
LAW_OF_POINTS(neo_hookean, "neo-hookean");
LAW_OF_POINTS(maxwell, "neo-hookean-maxwell");
LAW_OF_POINTS(von_mises_elastic, "von-mises elastic");
LAW_OF_POINTS(von_mises_flowing, "von-mises flowing");
LAW_OF_POINTS(drucker_prager_flowing, "drucker-prager flowing");

void plain_internal_forces(benchmark::State& state, Cloud& (*cloud)()) {
  const Cloud& grains = cloud();
  std::vector<baseline::Body> bodies = baseline::bodies_of(grains.model, grains.state.position);
  const Threads threads(state);
  for (auto _ : state) baseline::internal_forces(bodies);
  report(state, "point", integration_points(grains.model), {});
}
#define PLAIN_INTERNAL_FORCES(scene, name)               \
  BENCHMARK_CAPTURE(plain_internal_forces, scene, scene) \
      ->Name("baseline/internal_forces/" name)           \
      ->Apply(one_and_two_threads)
PLAIN_INTERNAL_FORCES(mls, "mls");
PLAIN_INTERNAL_FORCES(mls_gauss, "mls-gauss");
PLAIN_INTERNAL_FORCES(es_t3, "es-t3");
PLAIN_INTERNAL_FORCES(t3, "t3");
PLAIN_INTERNAL_FORCES(same_topology, "mls-same-topology");

/// Prediction and end of a step of velocity Verlet, with its error.
void update(benchmark::State& state) {
  Cloud& grains = mls();
  const Threads threads(state);
  for (auto _ : state) {
    grains.verlet->predict(grains.state, dt);
    parallel_for(static_cast<int>(grains.model.regions.size()),
                 [&](int r) { grains.verlet->update_region(grains.state, dt, r); });
  }
  report(state, "node", field_nodes(grains.model), work::update(grains.model));
}
BENCHMARK(update)->Apply(one_and_two_threads);

void plain_update(benchmark::State& state) {
  const Cloud& grains = mls();
  std::vector<baseline::Body> bodies = baseline::bodies_of(grains.model, grains.state.position);
  const Threads threads(state);
  for (auto _ : state) benchmark::DoNotOptimize(baseline::update(bodies, dt));
  report(state, "node", field_nodes(grains.model), {});
}
BENCHMARK(plain_update)->Name("baseline/update")->Apply(one_and_two_threads);

void place(benchmark::State& state) {
  const Cloud& grains = mls();
  const Threads threads(state);
  OutlineField outlines(grains.model.outline_offset.back());
  for (auto _ : state) place_outlines(grains.model, grains.state.position, outlines);
  report(state, "node", outline_nodes(grains.model), work::place_outlines(grains.model));
}
BENCHMARK(place)->Name("outlines/place")->Apply(one_and_two_threads);

void plain_place(benchmark::State& state) {
  const Cloud& grains = mls();
  std::vector<baseline::Body> bodies = baseline::bodies_of(grains.model, grains.state.position);
  const Threads threads(state);
  for (auto _ : state) baseline::place_outlines(bodies);
  report(state, "node", outline_nodes(grains.model), {});
}
BENCHMARK(plain_place)->Name("baseline/outlines/place")->Apply(one_and_two_threads);

void gather(benchmark::State& state) {
  const Cloud& grains = mls();
  const Model& model = grains.model;
  const Threads threads(state);
  const OutlineField& on_outlines = grains.state.outlines.position;  // some numbers, none of them 0
  Dofs force = zero_dofs(model);
  for (auto _ : state)
    parallel_for(model.lane_batches, [&](int b) {
      add_outline_forces(model, model.regions[b], on_outlines, &force.compliant[model.batches[b].offset]);
    });
  report(state, "node", outline_nodes(model), work::gather_outline_forces(model));
}
BENCHMARK(gather)->Name("outlines/gather")->Apply(one_and_two_threads);

void plain_gather(benchmark::State& state) {
  const Cloud& grains = mls();
  std::vector<baseline::Body> bodies = baseline::bodies_of(grains.model, grains.state.position);
  for (baseline::Body& body : bodies)
    for (baseline::OutlineNode& node : body.outline) node.fx = node.fy = 1;
  const Threads threads(state);
  for (auto _ : state) baseline::gather_outline_forces(bodies);
  report(state, "node", outline_nodes(grains.model), {});
}
BENCHMARK(plain_gather)->Name("baseline/outlines/gather")->Apply(one_and_two_threads);

/// Prediction, outlines placed, their forces gathered, internal forces, end of the step: all of a step but contact.
void compliant_step(benchmark::State& state) {
  Cloud& grains = mls();
  const Model& model = grains.model;
  const Threads threads(state);
  Trial& trial = grains.verlet->trial();
  trial.outlines.position = OutlineField(model.outline_offset.back());
  for (auto _ : state) {
    grains.verlet->predict(grains.state, dt);
    place_outlines(model, trial.position, trial.outlines.position);
    parallel_for(model.lane_batches, [&](int b) {
      const Batch& batch = model.batches[b];
      Lanes* f = &trial.force.compliant[batch.offset];
      std::fill_n(f, 2 * batch.slots, Lanes{});
      add_outline_forces(model, model.regions[b], trial.contact_force, f);
      benchmark::DoNotOptimize(
          add_internal_forces(model, batch, {.position = &trial.position.compliant[batch.offset]}, f));
      grains.verlet->update_region(grains.state, dt, b);
    });
  }
  report(state, "point", integration_points(model),
         work::internal_forces(model) + work::update(model) + work::place_outlines(model) +
             work::gather_outline_forces(model));
}
BENCHMARK(compliant_step)->Apply(one_and_two_threads);

void plain_compliant_step(benchmark::State& state) {
  const Cloud& grains = mls();
  std::vector<baseline::Body> bodies = baseline::bodies_of(grains.model, grains.state.position);
  const Threads threads(state);
  for (auto _ : state) benchmark::DoNotOptimize(baseline::compliant_step(bodies, dt));
  report(state, "point", integration_points(grains.model), {});
}
BENCHMARK(plain_compliant_step)->Name("baseline/compliant_step")->Apply(one_and_two_threads);

}  // namespace
}  // namespace pliant::kernels
