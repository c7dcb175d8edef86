// Kernels of contact in the third body: forces of three laws, everything from degrees of freedom to degrees of freedom,
// and candidates.
#include <algorithm>

#include "benchmarks/kernels/meter.hpp"
#include "benchmarks/kernels/plain_scene.hpp"
#include "benchmarks/kernels/scenes.hpp"
#include "benchmarks/kernels/work.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/place_outlines.hpp"
#include "bonds/bond_system.hpp"
#include "core/parallel.hpp"

namespace pliant::kernels {
namespace {

using enum ContactLawKind;

double least_spacing(const Model& model) {
  return std::ranges::min(model.outlines, {}, &OutlineShape::spacing).spacing;
}

void count_contacts(benchmark::State& state, const ContactSystem& contact, int contacts) {
  state.counters["contacts"] = contacts;
  state.counters["pairs"] = static_cast<double>(contact.contact_pairs().size());
}

void contact_forces(benchmark::State& state, ContactLawKind law,
                    ContactQuadrature quadrature = ContactQuadrature::nodes) {
  ContactScene& scene = third_body_with(law, quadrature);
  const Threads threads(state);
  int contacts = 0;
  for (auto _ : state)
    contacts = scene.contact.forces(scene.outlines, scene.history, scene.trial, scene.force).contacts;
  count_contacts(state, scene.contact, contacts);
  report(state, "record", records(scene.contact), work::contact_forces(scene.model, scene.contact));
}
BENCHMARK_CAPTURE(contact_forces, frictionless, frictionless)->Name("contact/frictionless")->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(contact_forces, mohr_coulomb, mohr_coulomb)->Name("contact/mohr-coulomb")->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(contact_forces, cohesive, cohesive)->Name("contact/cohesive")->Apply(one_and_two_threads);

/// The same, integrated over segments.
void integrated_forces(benchmark::State& state, ContactLawKind law) {
  contact_forces(state, law, ContactQuadrature::segments);
}
BENCHMARK_CAPTURE(integrated_forces, frictionless, frictionless)
    ->Name("contact/frictionless_integrated")
    ->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(integrated_forces, mohr_coulomb, mohr_coulomb)
    ->Name("contact/mohr-coulomb_integrated")
    ->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(integrated_forces, cohesive, cohesive)
    ->Name("contact/cohesive_integrated")
    ->Apply(one_and_two_threads);

/// Whole bonds, softening ones and torn ones alike, as all lanes compute all of the law. Cement joins all that is near
/// in the third body.
void bond_forces(benchmark::State& state) {
  const ContactScene& scene = third_body_with(mohr_coulomb);
  static const Model model = [&] {
    Model cemented = scene.model;
    BondRule rule;
    rule.first = rule.second = "all";
    rule.gap = 0.2 * least_spacing(scene.model);
    rule.strength = 1e8, rule.fracture_energy = 1;
    cemented.scene.bonds = {rule};
    return cemented;
  }();
  const Threads threads(state);
  const LawTable laws(model);
  BondSystem bonds(model, laws);
  BondHistory history, trial;
  bonds.make(scene.at_first.position, 0, history);
  OutlineField force = scene.force;
  for (auto _ : state) bonds.add_forces(scene.outlines.position, history, trial, force);
  report(state, "bond", static_cast<double>(bonds.bonds().size()), work::bond_forces(bonds));
}
BENCHMARK(bond_forces)->Name("bonds/whole")->Apply(one_and_two_threads);

void plain_contact_forces(benchmark::State& state, ContactLawKind law) {
  const ContactScene& scene = third_body_with(law);
  PlainScene plain(scene);
  const Threads threads(state);
  for (auto _ : state) plain.contact.forces(plain.bodies);
  count_lists(state, plain, "record", records(scene.contact));
}
BENCHMARK_CAPTURE(plain_contact_forces, frictionless, frictionless)
    ->Name("baseline/contact/frictionless")
    ->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(plain_contact_forces, mohr_coulomb, mohr_coulomb)
    ->Name("baseline/contact/mohr-coulomb")
    ->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(plain_contact_forces, cohesive, cohesive)
    ->Name("baseline/contact/cohesive")
    ->Apply(one_and_two_threads);

/// Outlines placed, contact forces, and these gathered on nodes and as forces and moments.
void contact_from_dofs(benchmark::State& state, ContactLawKind law) {
  ContactScene& scene = third_body_with(law);
  const Model& model = scene.model;
  const Threads threads(state);
  Dofs force = zero_dofs(model);
  for (auto _ : state) {
    place_outlines(model, scene.now, scene.outlines.position);
    scene.contact.forces(scene.outlines, scene.history, scene.trial, scene.force);
    parallel_for(static_cast<int>(model.regions.size()), [&](int r) {
      const Region& region = model.regions[r];
      add_outline_forces(model, region, scene.force, &force.compliant[model.batches[region.batch].offset]);
    });
    parallel_for(static_cast<int>(model.rigid_bodies.size()), [&](int r) {
      outline_force_resultant(model, model.rigid_bodies[r], scene.outlines.position, scene.force,
                              &scene.now.rigid[3 * static_cast<std::size_t>(r)],
                              &force.rigid[3 * static_cast<std::size_t>(r)]);
    });
  }
  report(state, "record", records(scene.contact),
         work::contact_forces(model, scene.contact) + work::place_outlines(model) + work::gather_outline_forces(model));
}
BENCHMARK_CAPTURE(contact_from_dofs, mohr_coulomb, mohr_coulomb)
    ->Name("contact/mohr-coulomb_and_outlines")
    ->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(contact_from_dofs, cohesive, cohesive)
    ->Name("contact/cohesive_and_outlines")
    ->Apply(one_and_two_threads);

void plain_contact_from_dofs(benchmark::State& state, ContactLawKind law) {
  const ContactScene& scene = third_body_with(law);
  PlainScene plain(scene);
  const Threads threads(state);
  for (auto _ : state) {
    baseline::place_outlines(plain.bodies);
    plain.contact.forces(plain.bodies);
    baseline::gather_outline_forces(plain.bodies);
  }
  count_lists(state, plain, "record", records(scene.contact));
}
BENCHMARK_CAPTURE(plain_contact_from_dofs, mohr_coulomb, mohr_coulomb)
    ->Name("baseline/contact/mohr-coulomb_and_outlines")
    ->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(plain_contact_from_dofs, cohesive, cohesive)
    ->Name("baseline/contact/cohesive_and_outlines")
    ->Apply(one_and_two_threads);

/// Boxes of all outlines, and of each pair's arcs: outlines are read, contact pairs and history written. Comparisons
/// are no flops.
Work searching(const ContactScene& scene) {
  return {0, 2 * sizeof(double) * outline_nodes(scene.model) + 32 * records(scene.contact) +
                 sizeof(ContactPair) * static_cast<double>(scene.contact.contact_pairs().size())};
}

void find_candidates(benchmark::State& state) {
  const ContactScene& scene = third_body_with(cohesive);
  const Threads threads(state);
  ContactSystem contact(scene.model);
  ContactHistory history;
  for (auto _ : state) contact.find_candidates(scene.outlines, history);
  report(state, "pair", static_cast<double>(contact.contact_pairs().size()), searching(scene));
}
BENCHMARK(find_candidates)->Name("candidates/find")->Apply(one_and_two_threads);

/// Boxes of all bodies, each against all, and of the bodies that are near each node against each segment.
void plain_find_candidates(benchmark::State& state) {
  const ContactScene& scene = third_body_with(cohesive);
  PlainScene plain(scene);
  const Threads threads(state);
  for (auto _ : state) plain.contact.find_candidates(plain.bodies);
  count_lists(state, plain, "pair", static_cast<double>(scene.contact.contact_pairs().size()));
}
BENCHMARK(plain_find_candidates)->Name("baseline/candidates/find")->Apply(one_and_two_threads);

/// To and fro between two places five steps apart: pairs keep what was found until their ways add up to half of the
/// skin. Counter `searched`: pairs that did not.
void renew_candidates(benchmark::State& state) {
  const ContactScene& scene = third_body_with(cohesive);
  const Threads threads(state);
  ContactSystem contact(scene.model);
  ContactHistory history;
  contact.find_candidates(scene.at_first, history);
  const Outlines* place[] = {&scene.outlines, &scene.at_first};
  int next = 0;
  const long searched = contact.pairs_searched();
  for (auto _ : state) contact.renew_candidates(*place[next = 1 - next], history);
  state.counters["searched"] =
      benchmark::Counter(static_cast<double>(contact.pairs_searched() - searched), benchmark::Counter::kAvgIterations);
  report(state, "pair", static_cast<double>(contact.contact_pairs().size()), searching(scene));
}
BENCHMARK(renew_candidates)->Name("candidates/renew")->Apply(one_and_two_threads);

/// Whether the candidates hold, which each step asks: the way of each outline node, two outlines read, 2 flops.
void watch_candidates(benchmark::State& state) {
  const ContactScene& scene = third_body_with(cohesive);
  const Threads threads(state);
  ContactSystem contact(scene.model);
  ContactHistory history;
  contact.find_candidates(scene.at_first, history);
  for (auto _ : state) benchmark::DoNotOptimize(contact.candidates_hold(scene.outlines.position));
  const double nodes = outline_nodes(scene.model);
  report(state, "node", nodes, {2 * nodes, 4 * sizeof(double) * nodes});
}
BENCHMARK(watch_candidates)->Name("candidates/hold")->Apply(one_and_two_threads);

}  // namespace
}  // namespace pliant::kernels
