// What audits take over from the steps before them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "dynamics/step_doubling.hpp"
#include "dynamics/verlet.hpp"
#include "support/bench.hpp"
#include "support/scenes.hpp"

namespace pliant::dynamics_tests {
namespace {

using namespace testing;

/// Returns how many trials were rejected.
template <class Scheme>
int expect_what_forces_store(const Scene& scene) {
  Bench bench(scene);
  Scheme scheme(bench.forces, bench.state);
  Trial trial(bench.model);
  int touching = 0, rejections = 0;
  for (int step = 0; step < 600; ++step) {
    rejections += take_step(scheme, bench.forces, bench.state, bench.control, 1e9).rejections;
    const Evaluation here = bench.evaluate(trial);
    const double stored = here.contact.stored;
    EXPECT_NEAR(bench.state.contact_energy, stored, 1e-12 * std::max(std::abs(stored), 1e-3)) << "step " << step;
    EXPECT_EQ(bench.state.contacts, here.contact.contacts) << "step " << step;
    touching += here.contact.contacts > 0;
  }
  EXPECT_GT(touching, 100);
  return rejections;
}

// EXACT: what a state has of its contacts is what forces at its own positions store, from its own memory on: there
// nothing slips. Of laws that slip and forget, in a layer that is pressed and sheared, through searches for
// candidates and rejected steps; at the end of a step of either scheme. Rounding of the sums.
TEST(EnergyAccountant, contact_energy_is_that_of_the_forces) {
  int rejections = 0;
  for (const ContactRule& rule : {frictionless(100), mohr_coulomb(100, 0.4), cohesive(100, 0.1, 0.02, 0.1),
                                  smoothed(mohr_coulomb(100, 0.4), 0.3)}) {
    Scene scene = small_third_body(1e9);
    scene.contacts = {rule};
    scene.time.tolerance = 1e-3;
    SCOPED_TRACE(fmt::format("law {}", static_cast<int>(rule.law)));
    rejections += expect_what_forces_store<Verlet>(scene);
    scene.contact.energy_consistent = false;
    rejections += expect_what_forces_store<Verlet>(scene);
    scene.time.integrator = Integrator::step_doubling;
    rejections += expect_what_forces_store<StepDoubling>(scene);
  }
  EXPECT_GT(rejections, 0);
}

}  // namespace
}  // namespace pliant::dynamics_tests
