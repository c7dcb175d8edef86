#include "core/phase_times.hpp"

#include <gtest/gtest.h>

namespace pliant {
namespace {

/// Goes on only when told to.
struct TestClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<TestClock>;
  static inline time_point present{};
  static inline int reads = 0;
  static time_point now() { return ++reads, present; }
};
using Times = PhaseTimesBy<TestClock>;

void pass(int nanoseconds) { TestClock::present += std::chrono::nanoseconds(nanoseconds); }

double of(const Times::Seconds& seconds, Phase phase) { return seconds[static_cast<std::size_t>(phase)]; }

/// Ten of update, twenty of contact and, each eighth step from the first on, a hundred of a search in it.
void take_step(Times& times, int step) {
  times.begin_step(step);
  pass(10);
  times.enter(Phase::contact);
  pass(5);
  if (step % 8 == 0) times.apart(Phase::candidates, [] { pass(100); });
  pass(15);
  times.end_step();
  pass(2);  // a row of a table
}

// EXACT: equal steps are divided as they are, whether each is timed or not; what is rare counts as often as it happens.
TEST(PhaseTimes, add_up_to_the_wall_time) {
  Times times;
  const TestClock::time_point start = TestClock::present;
  for (int step = 0; step < 64; ++step) take_step(times, step);
  times.apart(Phase::output, [&] {
    pass(1000);
    times.enter(Phase::contact);  // forces for an output
    times.apart(Phase::candidates, [] { pass(1); });
  });
  const Times::Seconds seconds = times.seconds(std::chrono::duration<double>(TestClock::present - start).count());
  const double nano = 1e-9, rounding = 1e-20;
  EXPECT_NEAR(of(seconds, Phase::update), 64 * 10 * nano, rounding);
  EXPECT_NEAR(of(seconds, Phase::contact), 64 * 20 * nano, rounding);
  EXPECT_NEAR(of(seconds, Phase::candidates), 8 * 100 * nano, rounding);
  EXPECT_NEAR(of(seconds, Phase::output), (64 * 2 + 1001) * nano, rounding);
  EXPECT_EQ(of(seconds, Phase::internal), 0);
}

// EXACT: of sixteen steps one reads the clock, once to begin, to change and to end, and once more to begin the next.
TEST(PhaseTimes, most_steps_read_no_clock) {
  Times times;
  TestClock::reads = 0;
  for (int step = 1; step <= 16; ++step) {
    times.begin_step(step);
    times.enter(Phase::contact);
    times.end_step();
  }
  times.begin_step(17);
  EXPECT_EQ(TestClock::reads, 4);
}

TEST(PhaseTimes, without_steps_all_is_output) {  // EXACT
  const Times::Seconds seconds = Times().seconds(3);
  EXPECT_EQ(of(seconds, Phase::output), 3);
}

}  // namespace
}  // namespace pliant
