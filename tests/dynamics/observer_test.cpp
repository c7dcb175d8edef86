// Observers see what steps pass by (docs/method.md 6); that they change no bit is shown in restart_test.cpp.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "dynamics/step_doubling.hpp"
#include "dynamics/verlet.hpp"
#include "setup/build_model.hpp"
#include "support/bench.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

/// Some of them within one step, and some on its end.
TEST(Observers, see_a_fall_at_their_own_times) {
  Scene scene = free_disc(30, 2, moving({0.1, 0.3}));
  scene.gravity = {0, -0.2};
  const Model model = build_model(scene);
  Simulation simulation(model);
  const double mass = simulation.energy_balance().energy.kinetic / (0.5 * (0.1 * 0.1 + 0.3 * 0.3)), period = 0.013;
  int looks = 0;
  const Observer observer{[&] { return (looks + 1) * period; },
                          [&] {
                            const double t = ++looks * period;
                            EXPECT_NEAR(simulation.state().time, t, 1e-12 * t) << "EXACT";
                            EXPECT_NEAR(simulation.energy_balance().energy.kinetic / mass,
                                        0.5 * (0.1 * 0.1 + (0.3 - 0.2 * t) * (0.3 - 0.2 * t)), 1e-12)
                                << "EXACT: constant accelerations";
                            return looks < 153;
                          }};
  double before = 0;
  while (simulation.step(2, &observer).dt > 0) before = simulation.state().time;
  EXPECT_EQ(looks, 153);
  EXPECT_EQ(simulation.state().time, before) << "EXACT: the last step is not taken";
  EXPECT_LT(before, 153 * period);
  EXPECT_LT(simulation.state().steps, 100) << "or steps pass none by";
}

/// Verlet, but that the first attempt to end then fails.
struct FailsOnceAt {
  Verlet& verlet;
  double time;
  int attempts = 0;

  double first_dt() const { return verlet.first_dt(); }
  double largest_dt() const { return verlet.largest_dt(); }
  std::string governing() const { return verlet.governing(); }
  Trial& trial() { return verlet.trial(); }
  Proposal propose(const State& state, double next_dt, double until) const {
    return verlet.propose(state, next_dt, until);
  }
  void attempt(State& state, const Proposal& proposal, StepReport& report) {
    verlet.attempt(state, proposal, report);
    if (proposal.end_time == time && attempts++ == 0) report.error = std::numeric_limits<double>::infinity();
  }
  bool within_tolerance(const StepReport& report) const { return verlet.within_tolerance(report); }
  Verdict judge(const State& state, const StepControl& control, const Proposal& proposal,
                const StepReport& report) const {
    return verlet.judge(state, control, proposal, report);
  }
  void add_damping_work(const State& state, StepReport& report) { verlet.add_damping_work(state, report); }
  void accepted(State& state, const StepReport& report) { verlet.accepted(state, report); }
};

TEST(Observers, get_a_step_of_their_own_where_a_look_fails) {
  Bench bench(free_disc(30, 100, stretching(0.1)));
  Verlet verlet(bench.forces, bench.state);
  while (bench.state.time < 10) take_step(verlet, bench.forces, bench.state, bench.control, 100);
  FailsOnceAt scheme{verlet, bench.state.time + 0.4 * bench.control.next_dt};
  const Observer observer{[&] { return scheme.time; },
                          [] {
                            ADD_FAILURE() << "there is no state to look at";
                            return true;
                          }};
  const std::int64_t rejections = bench.state.rejections;
  take_step(scheme, bench.forces, bench.state, bench.control, 100, &observer);
  EXPECT_EQ(bench.state.time, scheme.time) << "EXACT";
  EXPECT_EQ(scheme.attempts, 2);
  EXPECT_EQ(bench.state.rejections, rejections) << "EXACT: no error asked for it";
}

/// A grain that is turned twice around within one step, beside another: where a look finds it, the candidates for
/// contact do not hold, and where the step ends they do.
template <class Scheme>
void look_where_candidates_do_not_hold(Integrator integrator) {
  Scene scene = empty_scene(100);
  scene.time.integrator = integrator;
  scene.shapes = {box_shape("block", 1, 0.5, 0.1)};
  scene.grains = {grains("turned", "block", BodyKind::rigid, {{0, 0}}),
                  grains("held", "block", BodyKind::rigid, {{1.14, 0}})};
  BoundaryCondition turned, held;
  turned.grains = "turned", held.grains = "held";
  turned.x = turned.y = held.x = held.y = held.angle = {AxisCondition::Mode::velocity, constant(0)};
  turned.angle = {AxisCondition::Mode::velocity, constant(2 * M_PI)};
  scene.boundary = {turned, held};
  const double duration = 2, time = 0.6;
  const auto refreshes_of_step = [&](double until, const Observer* observer) {
    Bench bench(scene);
    bench.control.next_dt = duration;
    Scheme scheme(bench.forces, bench.state);
    const long before = bench.forces.contact().refreshes();
    take_step(scheme, bench.forces, bench.state, bench.control, until, observer);
    return bench.forces.contact().refreshes() - before;
  };
  int looks = 0;
  const Observer observer{[&] { return looks == 0 ? time : 1e300; }, [&] { return ++looks > 0; }};
  EXPECT_GT(refreshes_of_step(time, nullptr), 0) << "a step that ends there finds them anew";
  EXPECT_EQ(refreshes_of_step(duration, nullptr), 0) << "EXACT: where it ends they hold";
  EXPECT_EQ(refreshes_of_step(duration, &observer), 0) << "EXACT: a look takes them as they are";
  EXPECT_EQ(looks, 1);
}

TEST(Observers, take_candidates_as_they_are) {
  look_where_candidates_do_not_hold<Verlet>(Integrator::verlet);
  look_where_candidates_do_not_hold<StepDoubling>(Integrator::step_doubling);
}

TEST(Observers, that_cannot_go_on_leave_the_state_as_it_was) {
  const Model model = build_model(small_third_body(2));
  Simulation simulation(model), other(model);
  advance(simulation, 0.5), advance(other, 0.5);
  const std::uint64_t hash = state_hash(simulation.state());
  const double time = simulation.state().time + 0.3 * simulation.control().next_dt;
  const Observer observer{[&] { return time; }, []() -> bool { throw std::runtime_error("the disk is full"); }};
  EXPECT_THROW(simulation.step(2, &observer), std::runtime_error);
  EXPECT_EQ(state_hash(simulation.state()), hash) << "EXACT";
  simulation.step(2), other.step(2);
  EXPECT_EQ(state_hash(simulation.state()), state_hash(other.state())) << "EXACT";
}

}  // namespace
}  // namespace pliant::dynamics_tests
