// What a run costs, in numbers that no other load of the machine touches.
#include <gtest/gtest.h>

#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

struct Counts {
  double pairs = 0, records = 0;  ///< a body, the largest while sheared
  double rebuilds = 0, searched = 0;  ///< a thousand steps; of all pairs, each time
  double nodes = 0;  ///< of outlines, a grain
};

Counts count(const Scene& scene, double from, double until) {
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, from);
  const ContactSystem& contact = simulation.forces().contact();
  const double bodies = static_cast<double>(model.bodies.size());
  const long steps = simulation.state().steps, rebuilds = contact.refreshes(), searched = contact.pairs_searched();
  Counts counts;
  while (simulation.state().time < until) {
    simulation.step(until);
    counts.pairs = std::max(counts.pairs, static_cast<double>(contact.patches().size()) / bodies);
    counts.records = std::max(counts.records, static_cast<double>(simulation.state().memory.contact.place.size()) / bodies);
  }
  counts.rebuilds = 1000.0 * static_cast<double>(contact.refreshes() - rebuilds) /
                    static_cast<double>(simulation.state().steps - steps);
  counts.searched = static_cast<double>(contact.pairs_searched() - searched) /
                    (static_cast<double>(contact.refreshes() - rebuilds) * static_cast<double>(contact.patches().size()));
  return counts;
}

TEST(Counters, of_candidates_in_a_sheared_layer) {
  const Counts counts = count(small_third_body(4), 1, 4);
  printf("%g %g %g %g\n", counts.pairs, counts.records, counts.rebuilds, counts.searched);
}

}  // namespace
}  // namespace pliant::dynamics_tests
