// A rejected step leaves no trace: the state goes on as if only the accepted step had been tried (docs/design.md 5,
// docs/method.md 6).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <type_traits>

#include "bodies/place_outlines.hpp"
#include "core/errors.hpp"
#include "setup/build_model.hpp"
#include "support/bench.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same_bits(const Dofs& a, const Dofs& b) {
  return same_bits(a.compliant, b.compliant) && same_bits(a.rigid, b.rigid);
}

/// Arc coordinates and slips of the nodes that slip, in an order of their own: a refresh may move records, and know
/// more or fewer nodes that are near but not in touch.
std::vector<std::pair<double, double>> records(const ContactHistory& history) {
  std::vector<std::pair<double, double>> slipping;
  for (int i = 0; i < history.records(); ++i)
    if (const double slip = history.number(i, ContactHistory::slip); slip != 0)
      slipping.emplace_back(history.number(i, ContactHistory::place), slip);
  std::sort(slipping.begin(), slipping.end());
  return slipping;
}

/// A step that was rejected at least once, and the same step taken at once from a copy of everything before it.
struct Twins {
  const State& retried;
  const State& direct;
  bool refreshed;  ///< some trial rebuilt the contact candidates
};

/// Runs a scene and shows each step with rejections to `look`. Returns how many there were.
template <class Integrator>
int compare_rejected_steps(const Scene& scene, const std::function<void(const Twins&)>& look) {
  Bench bench(scene);
  Integrator integrator(bench.forces, bench.state);
  int seen = 0;
  while (bench.state.time < scene.time.end) {
    // Now and then a step that is too long: else Verlet's controller sees to it that hardly any is rejected.
    if (bench.state.steps % 5 == 4 && std::is_same_v<Integrator, Verlet>) bench.control.next_dt = 1e9;
    State state = bench.state;
    Forces forces = bench.forces;
    const long refreshes = forces.contact().refreshes();
    const StepReport report = take_step(integrator, bench.forces, bench.state, bench.control, scene.time.end);
    if (report.rejections == 0) continue;
    ++seen;
    // Verlet divides what is left until the end by whole steps: for as many.
    StepControl control{std::is_same_v<Integrator, Verlet> ? report.dt * (1 + 1e-12) : report.dt};
    Integrator fresh(forces, state);
    take_step(fresh, forces, state, control, scene.time.end);
    look({bench.state, state, bench.forces.contact().refreshes() != refreshes});
  }
  return seen;
}

/// A compliant disc thrown at a rigid one that lies on a floor with friction; both slip and roll.
Scene impact(Integrator integrator) {
  Scene scene = on_a_floor(4, 8, 0.25, {0, -0.01});
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("thrown", "disc", BodyKind::compliant, {{3, 3.2}}, moving({0.15, -0.3})),
                  grains("lying", "disc", BodyKind::rigid, {{4, 0.999}})};
  scene.contacts = {mohr_coulomb(200, 0.4)};
  scene.time.integrator = integrator;
  scene.time.tolerance = 1e-4;
  return scene;
}

/// A rigid block that slides fast enough to use up the contact skin within a step, so that rejected trials rebuild
/// the candidates.
Scene fast_slide(Integrator integrator) {
  Scene scene = on_a_floor(20, 8, 0.1, {0.2, -1});
  scene.shapes = {box_shape("block", 1, 0.5, 0.1)};
  scene.grains = {grains("block", "block", BodyKind::rigid, {{2, 0.245}}, moving({3, 0}))};
  scene.contacts = {mohr_coulomb(100, 0.5)};
  scene.time.integrator = integrator;
  scene.time.tolerance = 1e-4;
  scene.time.target = 1e-2;
  return scene;
}

void expect_equal(const Twins& twins) {
  EXPECT_EQ(twins.retried.time, twins.direct.time) << "EXACT";
  EXPECT_TRUE(same_bits(twins.retried.position, twins.direct.position)) << "EXACT, t = " << twins.direct.time;
  // After a refresh nodes stand in other lanes, in which energies, and so the energy correction of contacts, are added
  // up.
  const double rounding = twins.refreshed ? 1e-14 : 0;
  EXPECT_LE(largest_difference(twins.retried.reduced_momentum, twins.direct.reduced_momentum), rounding)
      << "EXACT, t = " << twins.direct.time;
  EXPECT_LE(largest_difference(twins.retried.force, twins.direct.force), rounding)
      << "EXACT, t = " << twins.direct.time;
  const auto retried = records(twins.retried.memory.contact), direct = records(twins.direct.memory.contact);
  ASSERT_EQ(retried.size(), direct.size()) << "EXACT, t = " << twins.direct.time;
  for (std::size_t i = 0; i < direct.size(); ++i) {
    // EXACT but for rounding: after a refresh, places on a periodic wall may count from another turn.
    EXPECT_NEAR(retried[i].first, direct[i].first, 1e-14) << "t = " << twins.direct.time;
    EXPECT_NEAR(retried[i].second, direct[i].second, 1e-14) << "t = " << twins.direct.time;
  }
}

/// A trial that tears a sticking contact apart rebuilds the candidates; where the step started, everything is as it
/// was.
TEST(Rejection, a_trial_far_away_loses_no_record) {
  Bench bench(fast_slide(Integrator::verlet));
  Verlet integrator(bench.forces, bench.state);
  while (bench.state.time < 1) take_step(integrator, bench.forces, bench.state, bench.control, 1);
  State& state = bench.state;
  const auto before = records(state.memory.contact);
  ASSERT_FALSE(before.empty());
  Trial trial(bench.model);
  Dofs away = state.position;
  away.rigid[1] += 5;
  const Forces::ListCheck candidates = bench.forces.ensure_candidates(state, placed_outlines(bench.model, away), 1);
  EXPECT_TRUE(candidates.rebuilt) << "EXACT";
  EXPECT_FALSE(candidates.valid) << "EXACT: further than the skin";
  EXPECT_EQ(records(state.memory.contact), before) << "EXACT";
  EXPECT_TRUE(bench.evaluate(trial).valid);
  EXPECT_TRUE(same_bits(trial.force.rigid, state.force.rigid)) << "EXACT";
}

/// New candidates lay out the accepted memory anew, whatever trial asked for them: here they drop a first block, so
/// that the records of a second move.
TEST(Rejection, a_refresh_lays_out_the_accepted_history) {
  Scene scene = fast_slide(Integrator::step_doubling);
  scene.grains.push_back(grains("second", "block", BodyKind::rigid, {{8, 0.245}}, moving({2, 0})));
  Bench bench(scene);
  StepDoubling integrator(bench.forces, bench.state);
  while (bench.state.time < 1) take_step(integrator, bench.forces, bench.state, bench.control, 1);
  State& state = bench.state;
  state.position.rigid[1] += 5;
  state.outlines.position = placed_outlines(bench.model, state.position);
  Dofs away = state.position;
  away.rigid[3] += 1;
  EXPECT_TRUE(bench.forces.ensure_candidates(state, placed_outlines(bench.model, away), 1).rebuilt);
  Trial trial(bench.model);
  bench.evaluate(trial);
  const Dofs& force = trial.force;
  for (std::size_t c = 3; c < 6; ++c)
    EXPECT_NEAR(force.rigid[c], state.force.rigid[c], 1e-12) << "EXACT: rounding of forces of order 1";
  EXPECT_GT(std::abs(state.force.rigid[3]), 0.01) << "friction must act, or this test says nothing";
}

/// The floor gives way until contacts are lost, in the first or in the second evaluation of a step. Friction gives the
/// history something to lose.
TEST(Rejection, a_step_that_fails_changes_nothing) {
  for (const Integrator kind : {Integrator::verlet, Integrator::step_doubling})
    for (const double speed : {0.2, 0.25, 0.3, 0.35}) {
      Scene scene = impact(kind);
      scene.grains = {grains("falls", "disc", BodyKind::compliant, {{3, 1.1}}, moving({0.1, -speed}, 0.3))};
      scene.contacts = {mohr_coulomb(1, 0.4)};
      const Model model = build_model(scene);
      Simulation simulation(model);
      std::uint64_t before = 0;
      const auto run = [&] {
        while (simulation.state().time < 8) {
          before = state_hash(simulation.state());
          simulation.step(8);
        }
      };
      EXPECT_THROW(run(), PhysicsError);
      EXPECT_GT(simulation.state().dissipated, 0) << "friction must have acted, or this test says little";
      EXPECT_EQ(state_hash(simulation.state()), before) << "EXACT, speed " << speed;
    }
}

TEST(Rejection, leaves_no_trace_in_verlet) {
  EXPECT_GT(compare_rejected_steps<Verlet>(impact(Integrator::verlet), expect_equal), 0);
  int refreshed = 0;
  compare_rejected_steps<Verlet>(fast_slide(Integrator::verlet), [&](const Twins& twins) {
    expect_equal(twins);
    refreshed += twins.refreshed;
  });
  EXPECT_GT(refreshed, 3);
}

TEST(Rejection, leaves_no_trace_in_step_doubling) {
  EXPECT_GT(compare_rejected_steps<StepDoubling>(impact(Integrator::step_doubling), expect_equal), 0);
  int refreshed = 0;
  compare_rejected_steps<StepDoubling>(fast_slide(Integrator::step_doubling), [&](const Twins& twins) {
    expect_equal(twins);
    refreshed += twins.refreshed;
  });
  EXPECT_GT(refreshed, 3);
}

/// Neither does looking at the energy balance: audits between the steps change no bit of the run.
TEST(Rejection, audits_leave_no_trace) {
  const Model model = build_model(impact(Integrator::verlet));
  Simulation watched(model), alone(model);
  while (watched.state().time < 4) {
    watched.energy_balance();
    watched.step(4);
    alone.step(4);
    ASSERT_EQ(state_hash(watched.state()), state_hash(alone.state())) << "EXACT, t = " << alone.state().time;
  }
}

}  // namespace
}  // namespace pliant::dynamics_tests
