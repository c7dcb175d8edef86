#include "core/floating_point_traps.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <limits>

namespace pliant {
namespace {

/// In builds with assertions the whole test program is trapped as the engine and the reference solver are.
[[maybe_unused]] const bool trapped = (trap_floating_point_errors(), true);

/// EXACT.
TEST(FloatingPointTraps, EndTheProgramWhereNumbersComeToNothing) {
#ifdef NDEBUG
  GTEST_SKIP() << "no assertions in this build";
#else
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  volatile double zero = 0, largest = std::numeric_limits<double>::max();
  const auto killed = testing::KilledBySignal(SIGFPE);
  EXPECT_EXIT(static_cast<void>(zero = 1 / zero), killed, "");
  EXPECT_EXIT(static_cast<void>(zero = zero / zero), killed, "");
  EXPECT_EXIT(static_cast<void>(zero = largest * largest), killed, "");
#endif
}

}  // namespace
}  // namespace pliant
