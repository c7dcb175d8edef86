#pragma once

#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "bodies/model.hpp"
#include "dynamics/simulation.hpp"

namespace pliant::kernels {

/// Compliant discs that touch nothing, slightly deformed, each otherwise, and all that a step of them needs.
struct Cloud {
  explicit Cloud(Model built);
  Cloud(const Cloud&) = delete;
  Model model;
  Forces forces;
  State state;
  std::unique_ptr<Verlet> verlet;
};

/// 1000 grains of 168 nodes, one shape: a shared table in lanes. `mls_gauss` with 3 points a triangle.
Cloud& grains_of(DiscretisationMethod method);
/// 1000 such grains by `mls` with a law whose points flow from a yield stress of `yield`, Pa.
Cloud& grains_with(MaterialLaw law, double yield = 0);
/// 200 Fourier grains of 168 nodes, each of its own shape, with common connectivity.
Cloud& same_topology();
/// One disc of 10,000 nodes, vectorised over its nodes.
Cloud& large_body();

/// The full third body after a few hundred steps with a pressed-on wall; PLIANT_BENCH_FROM=DIR: the scene and state of
/// the checkpoint of that run.
Simulation& third_body();

/// The third body with another contact law, in the same state; each contact has slipped by what came in five steps.
struct ContactScene {
  explicit ContactScene(ContactLawKind law, ContactQuadrature quadrature);
  ContactScene(const ContactScene&) = delete;
  Model model;
  Dofs before, now;   ///< positions
  Outlines at_first;  ///< before
  Outlines outlines;  ///< now
  ContactSystem contact;
  ContactHistory history;  ///< of `before`
  ContactHistory trial;
  OutlineField force;
};
ContactScene& third_body_with(ContactLawKind law, ContactQuadrature quadrature = ContactQuadrature::nodes);
const char* name_of(ContactLawKind law);

}  // namespace pliant::kernels
