// What a run costs, in numbers that no other load of the machine touches.
#include <gtest/gtest.h>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

struct Counts {
  double pairs = 0, records = 0;      ///< a body, the largest while sheared
  double rebuilds = 0, searched = 0;  ///< a thousand steps; pairs searched in them, a body
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
    counts.pairs = std::max(counts.pairs, static_cast<double>(contact.contact_pairs().size()) / bodies);
    counts.records =
        std::max(counts.records, static_cast<double>(simulation.state().memory.contact.records()) / bodies);
  }
  const double thousands = 1e-3 * static_cast<double>(simulation.state().steps - steps);
  counts.rebuilds = static_cast<double>(contact.refreshes() - rebuilds) / thousands;
  counts.searched = static_cast<double>(contact.pairs_searched() - searched) / (thousands * bodies);
  return counts;
}

TEST(Counters, of_candidates_in_a_sheared_layer) {
  const Counts counts = count(small_third_body(4), 1, 4);
  EXPECT_LT(counts.pairs, 3.6)
      << "FROZEN: 3.2 when written; 3 neighbours of six a body, and what boxes see beyond them";
  EXPECT_LT(counts.records, 70) << "FROZEN: 57 when written; 36 outline nodes a grain, in arcs of whole lanes";
  EXPECT_LT(counts.rebuilds, 90) << "FROZEN: 78 of a thousand steps when written; discs of ways hold more than boxes";
  EXPECT_LT(counts.searched, 35) << "FROZEN: 29 when written, of 3.2 pairs a body";
}

}  // namespace
}  // namespace pliant::dynamics_tests
