#include "core/lanes.hpp"

#include <gtest/gtest.h>

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace pliant {
namespace {

constexpr Lanes counting = {0, 1, 2, 3, 4, 5, 6, 7};

// EXACT: every case below is one IEEE operation.
TEST(Lanes, LoadStoreBroadcast) {
  double values[lane_count + 1];
  for (int i = 0; i <= lane_count; ++i) values[i] = 0.5 * i;
  const Lanes loaded = load(values + 1);  // any alignment
  double back[lane_count];
  store(back, loaded);
  for (int lane = 0; lane < lane_count; ++lane) {
    EXPECT_EQ(loaded[lane], values[lane + 1]);
    EXPECT_EQ(back[lane], values[lane + 1]);
    EXPECT_EQ(broadcast(-2.5)[lane], -2.5);
  }
}

// EXACT.
TEST(Lanes, SelectMinMaxAbs) {
  const Lanes other = 7.0 - counting;
  const Lanes chosen = select(counting < other, counting, -other);
  for (int lane = 0; lane < lane_count; ++lane) {
    EXPECT_EQ(chosen[lane], lane < 4 ? lane : lane - 7);
    EXPECT_EQ(min(counting, other)[lane], std::min(lane, 7 - lane));
    EXPECT_EQ(max(counting, other)[lane], std::max(lane, 7 - lane));
    EXPECT_EQ(abs(counting - 3.5)[lane], std::abs(lane - 3.5));
  }
}

// EXACT: select must not let the other branch's NaN or infinity through.
TEST(Lanes, SelectKeepsBadValuesOut) {
  const Lanes bad = counting < 4.0 ? Lanes{} / Lanes{} : 1.0 / Lanes{};
  const Lanes clean = select(bad == counting, bad, counting);
  for (int lane = 0; lane < lane_count; ++lane) EXPECT_EQ(clean[lane], lane);
}

// EXACT: IEEE square roots are correctly rounded.
TEST(Lanes, SquareRoots) {
  const Lanes a = {0, 1e-300, 2, 3, 1e10, 0.1, 7, 1e300};
  for (int lane = 0; lane < lane_count; ++lane) EXPECT_EQ(sqrt(a)[lane], std::sqrt(a[lane]));
}

// EXACT: ties to even, as std::nearbyint in the default mode, up to the stated 2^51.
TEST(Lanes, RoundToInteger) {
  const Lanes cases[] = {{0.5, 1.5, 2.5, -0.5, -1.5, -2.5, 0.49999999999999994, -0.49999999999999994},
                         {0, -0.0, 1, -1, 1e15 + 0.5, -1e15 - 0.5, 2251799813685246.5, -2251799813685246.5},
                         {0.1, -0.9, 123456.7, -123456.2, 1e-300, 3.5, 4.5, 1e9 + 0.25}};
  for (const Lanes& a : cases)
    for (int lane = 0; lane < lane_count; ++lane) EXPECT_EQ(round_to_integer(a)[lane], std::nearbyint(a[lane]));
}

// EXACT.
TEST(Lanes, MasksOfTheFirstLanes) {
  for (int count = -1; count <= lane_count + 3; ++count) {
    const LaneBits mask = first_lanes(count);
    for (int lane = 0; lane < lane_count; ++lane) EXPECT_EQ(mask[lane] != 0, lane < count);
    EXPECT_EQ(any(mask), count > 0);
  }
  EXPECT_TRUE(any(counting == 7.0));
  EXPECT_FALSE(any(counting == 8.0));
}

// EXACT.
TEST(Lanes, ExponentsOfPowersOfTwo) {
  for (int first = 0; first < 48; ++first) {
    LaneBits powers{};
    for (int lane = 0; lane < lane_count; ++lane) powers[lane] = std::int64_t{1} << (first + lane) % 52;
    for (int lane = 0; lane < lane_count; ++lane) EXPECT_EQ(exponent_of(powers)[lane], (first + lane) % 52);
  }
}

// EXACT: the sum's order is part of the promise of equal bits; largest takes every lane into account.
TEST(Lanes, SumAndLargest) {
  const Lanes a = {1e16, 1, -1e16, 1, 3, 1e-3, 0.1, 0.7};
  const double pairs = ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
  EXPECT_EQ(sum(a), pairs);
  for (int at = 0; at < lane_count; ++at) {
    Lanes b = -counting;
    b[at] = 5;
    EXPECT_EQ(largest(b), 5);
  }
  EXPECT_EQ(largest(-1.0 - counting), -1);
}

// EXACT, wherever the largest is, also in what is left after whole vectors.
TEST(Lanes, LargestOfManyValues) {
  EXPECT_EQ(largest({}, -3), -3);
  for (std::size_t size = 1; size < 3 * lane_count; ++size)
    for (std::size_t at = 0; at < size; ++at) {
      std::vector<double> values(size);
      std::iota(values.begin(), values.end(), -100.0);
      EXPECT_EQ(largest(values, 7), 7);
      values[at] = 9;
      EXPECT_EQ(largest(values, 7), 9) << at << " of " << size;
    }
}

// EXACT: the system has given out none of the pages inside a new array until a thread writes to it. The array is larger
// than what the C library takes from memory in use (32 MB).
TEST(Lanes, NewNumbersAreNotTouched) {
#ifndef NDEBUG
  GTEST_SKIP() << "new numbers are NaN in this build";
#endif
  LinedNumbers numbers(std::size_t{1} << 23);
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const auto resident = [&](std::size_t at) {
    void* start = reinterpret_cast<void*>(reinterpret_cast<std::uintptr_t>(&numbers[at]) / page * page);
    unsigned char in_memory = 0;
    EXPECT_EQ(mincore(start, page, &in_memory), 0);
    return (in_memory & 1) != 0;
  };
  for (std::size_t at = numbers.size() / 4; at < numbers.size(); at += numbers.size() / 4) {
    EXPECT_FALSE(resident(at));
    numbers[at] = 1;
    EXPECT_TRUE(resident(at));
  }
}

}  // namespace
}  // namespace pliant
