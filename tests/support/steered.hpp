#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "dynamics/energy.hpp"
#include "dynamics/step_doubling.hpp"
#include "dynamics/verlet.hpp"
#include "support/bench.hpp"

namespace pliant::dynamics_tests {

/// A simulation whose steps a test chooses, so that two models can take the same ones.
struct Steered {
  Bench bench;
  EnergyAccountant auditor;
  std::unique_ptr<Verlet> verlet;
  std::unique_ptr<StepDoubling> step_doubling;

  explicit Steered(Model model) : bench(std::move(model)), auditor(bench.model, bench.state) {
    if (bench.model.scene.time.integrator == Integrator::verlet)
      verlet = std::make_unique<Verlet>(bench.forces, bench.state);
    else
      step_doubling = std::make_unique<StepDoubling>(bench.forces, bench.state);
  }

  /// One step of dt, which stability and error must allow.
  StepReport step(double dt) {
    bench.control.next_dt = 1e300;
    const double until = bench.state.time + dt;
    return verlet ? take_step(*verlet, bench.forces, bench.state, bench.control, until)
                  : take_step(*step_doubling, bench.forces, bench.state, bench.control, until);
  }
};

/// Of sums of some twenty terms in another order, times what a disc's stiffness makes of rounded positions.
constexpr double rounding_of_order = 1e-12;

inline void expect_equal_points(const Points& a, const Points& b, double tolerance, const char* what) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_LT((a[i] - b[i]).norm(), tolerance) << "EXACT: " << what << " " << i;
}

/// INDEPENDENT: the stability bounds agree to a share that power iterations from elsewhere may differ by.
inline void expect_same_bound(const Steered& here, const Steered& there, double share) {
  if (here.verlet) EXPECT_NEAR(here.verlet->bound().largest_dt() / there.verlet->bound().largest_dt(), 1, share);
}

/// Both take the same steps of dt. Returns the largest number of contacts. EXACT: error estimates agree to 1e-9, the
/// rounding of some hundred steps, of themselves, or of `floor`.
inline int step_side_by_side(Steered& here, Steered& there, double dt, int steps, double floor) {
  int contacts = 0;
  for (int step = 0; step < steps && !::testing::Test::HasFailure(); ++step) {
    const StepReport a = here.step(dt), b = there.step(dt);
    EXPECT_EQ(a.rejections + b.rejections, 0);
    EXPECT_NEAR(a.dt, dt, 1e-12);
    EXPECT_NEAR(b.dt, dt, 1e-12);
    EXPECT_NEAR(a.error, b.error, 1e-9 * std::max(floor, b.error)) << "step " << step;
    contacts = std::max(contacts, b.evaluation.contact.contacts);
  }
  return contacts;
}

}  // namespace pliant::dynamics_tests
