// Whole evaluations and steps of the third body, and what bounds its steps.
#include <algorithm>

#include "benchmarks/kernels/meter.hpp"
#include "benchmarks/kernels/plain_scene.hpp"
#include "benchmarks/kernels/scenes.hpp"
#include "benchmarks/kernels/work.hpp"

namespace pliant::kernels {
namespace {

double grains(const Simulation& simulation) {
  const auto& bodies = simulation.model().bodies;
  return static_cast<double>(std::ranges::count(bodies, false, &Body::wall));
}

Work evaluation_of(const Simulation& simulation) {
  const Model& model = simulation.model();
  return work::contact_forces(model, simulation.forces().contact()) + work::place_outlines(model) +
         work::gather_outline_forces(model) + work::internal_forces(model);
}

/// Two power iterations: internal forces at rest, and twice beside it; of each component of a node some 12 flops an
/// iteration, vectors of the directions, probes and responses once read and written.
void bound_of_internal_forces(benchmark::State& state) {
  const Simulation& simulation = third_body();
  const Model& model = simulation.model();
  const Threads threads(state);
  TimeStepBound bound(model, simulation.forces().contact().laws());
  bound.update_internal(simulation.state().position, simulation.state().memory);
  for (auto _ : state) bound.update_internal(simulation.state().position, simulation.state().memory);
  const double nodes = field_nodes(model), vector = 2 * sizeof(double);
  report(state, "node", nodes, 3 * work::internal_forces(model) + Work{2 * 2 * 12 * nodes, 6 * vector * nodes});
}
BENCHMARK(bound_of_internal_forces)->Name("bound/internal")->Apply(one_and_two_threads);

/// From all candidates, by a bound that has seen none of them: as contact forces, without their history.
void bound_of_contact(benchmark::State& state) {
  const Simulation& simulation = third_body();
  const ContactSystem& contact = simulation.forces().contact();
  const Threads threads(state);
  for (auto _ : state) {
    state.PauseTiming();
    TimeStepBound bound(simulation.model(), contact.laws());
    state.ResumeTiming();
    bound.update_contact(contact, simulation.forces().bonds());
  }
  const Work forces = work::contact_forces(simulation.model(), contact);
  report(state, "record", records(contact), {forces.flops, forces.bytes - 4 * sizeof(double) * records(contact)});
}
BENCHMARK(bound_of_contact)->Name("bound/contact")->Apply(one_and_two_threads);

void evaluation(benchmark::State& state) {
  const Simulation& simulation = third_body();
  const Threads threads(state);
  State now = simulation.state();
  now.memory = {};
  Forces forces(simulation.model());
  Trial trial(simulation.model());
  evaluate_at(forces, now, trial);  // finds the candidates
  for (auto _ : state) evaluate_at(forces, now, trial);
  report(state, "grain", grains(simulation), evaluation_of(simulation));
}
BENCHMARK(evaluation)->Apply(one_and_two_threads);

void evaluate(PlainScene& plain) {
  baseline::place_outlines(plain.bodies);
  plain.contact.forces(plain.bodies);
  baseline::gather_outline_forces(plain.bodies);
  baseline::internal_forces(plain.bodies);
}

void plain_evaluation(benchmark::State& state) {
  const ContactScene& scene = third_body_with(ContactLawKind::cohesive);
  PlainScene plain(scene);
  const Threads threads(state);
  for (auto _ : state) {
    baseline::clear_forces(plain.bodies);
    evaluate(plain);
  }
  count_lists(state, plain, "grain", grains(third_body()));
}
BENCHMARK(plain_evaluation)->Name("baseline/evaluation")->Apply(one_and_two_threads);

void step(benchmark::State& state) {
  Simulation& simulation = third_body();
  const Threads threads(state);
  for (auto _ : state) simulation.step(1e300);
  report(state, "grain", grains(simulation), evaluation_of(simulation) + work::update(simulation.model()));
}
BENCHMARK(step)->Apply(one_and_two_threads);

/// Steps of a fixed size, as plain codes take them: what the engine's step has besides, new candidates, bounds, energy
/// correction and the motion of rigid bodies, is left out.
void plain_step(benchmark::State& state) {
  const ContactScene& scene = third_body_with(ContactLawKind::cohesive);
  PlainScene plain(scene);
  const double dt = 0.5 * third_body().largest_dt();
  const Threads threads(state);
  for (auto _ : state) {
    baseline::predict(plain.bodies, dt);
    evaluate(plain);
    benchmark::DoNotOptimize(baseline::finish(plain.bodies, dt));
  }
  count_lists(state, plain, "grain", grains(third_body()));
}
BENCHMARK(plain_step)->Name("baseline/step")->Apply(one_and_two_threads);

}  // namespace
}  // namespace pliant::kernels
