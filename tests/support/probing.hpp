#pragma once

#include "results/probes/probes.hpp"
#include "support/simulations.hpp"

/// One probe's values, without a file.
namespace pliant::dynamics_tests {

inline Probe probe_of(const std::string& quantity, const std::string& of = {}) {
  Probe probe;
  probe.name = "probe";
  probe.quantity = quantity;
  probe.of = of;
  probe.period = 1;
  return probe;
}

inline Probe reduced_by(Reduction reduction, Probe probe) {
  probe.reduce = reduction;
  return probe;
}

inline Probe at_node(int node, Probe probe) {
  probe.node = node;
  return probe;
}

inline std::vector<double> measured(Simulation& simulation, const Probe& probe) {
  return ProbeSampler(simulation.model(), probe).sample(Snapshot(simulation));
}

/// Two components, or columns, of a probe.
inline Vec2 measured_vector(Simulation& simulation, const Probe& probe, std::size_t first = 0) {
  const std::vector<double> row = measured(simulation, probe);
  return {row.at(first), row.at(first + 1)};
}

}  // namespace pliant::dynamics_tests
