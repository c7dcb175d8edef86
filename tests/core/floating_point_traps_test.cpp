#include "core/floating_point_traps.hpp"

#include <gtest/gtest.h>

#include <sys/wait.h>

#include <limits>

namespace pliant {
namespace {

/// By the signal, or by what a sanitizer makes of it.
[[maybe_unused]] bool has_died(int status) { return !(WIFEXITED(status) && WEXITSTATUS(status) == 0); }

/// EXACT.
TEST(FloatingPointTraps, EndTheProgramWhereNumbersComeToNothing) {
#ifdef NDEBUG
  GTEST_SKIP() << "no assertions in this build";
#else
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  volatile double zero = 0, largest = std::numeric_limits<double>::max();
  EXPECT_EXIT(static_cast<void>(zero = 1 / zero), has_died, "");
  EXPECT_EXIT(static_cast<void>(zero = zero / zero), has_died, "");
  EXPECT_EXIT(static_cast<void>(zero = largest * largest), has_died, "");
#endif
}

}  // namespace
}  // namespace pliant
