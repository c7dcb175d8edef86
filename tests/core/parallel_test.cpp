#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <omp.h>
#include <array>

#include "support/random.hpp"

namespace pliant {
namespace {

// Runs an action with a given number of threads and puts the old number back.
template <class Action>
auto with_threads(int count, Action&& action) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(count);
  const auto result = action();
  omp_set_num_threads(before);
  return result;
}

// EXACT: the sum has the same bits for any number of threads (docs/design.md 5); numbers of very different size would
// betray another order.
TEST(Parallel, OrderedSumDoesNotDependOnThreads) {
  testing::Random random(4);
  for (const int size : {0, 1, 255, 256, 257, 10000}) {
    std::vector<double> values;
    for (int i = 0; i < size; ++i) {
      const double digits = random.uniform(-1, 1), power = random.uniform(0, 20);
      values.push_back(digits * std::pow(10.0, power));
    }
    const auto total = [&] { return ordered_sum(size, [&](int i) { return values[i]; }); };
    const double one = with_threads(1, total);
    for (const int threads : {2, 3, 7})
      EXPECT_EQ(with_threads(threads, total), one) << size << " values, " << threads << " threads";
  }
}

// EXACT, with fewer and more indices than threads.
TEST(Parallel, VisitsEveryIndexOnce) {
  for (const int threads : {1, 3, 7})
    for (const int size : {0, 1, 2, 7, 8, 1000}) {
      const auto visited = with_threads(threads, [&] {
        std::vector<int> count(static_cast<std::size_t>(size), 0);
        parallel_for(size, [&](int i) { ++count[i]; });
        parallel_for_uneven(size, 7, [&](int i) { ++count[i]; });
        return count;
      });
      for (int c : visited) EXPECT_EQ(c, 2) << size << " indices, " << threads << " threads";
    }
}

// EXACT: one share after the other, as equal as can be.
TEST(Parallel, SharesAreContiguousAndEqual) {
  const auto owner = with_threads(3, [] {
    std::vector<int> owner(8);
    parallel_for(8, [&](int i) { owner[i] = omp_get_thread_num(); });
    return owner;
  });
  EXPECT_EQ(owner, (std::vector<int>{0, 0, 0, 1, 1, 1, 2, 2}));
}

// EXACT.
TEST(Parallel, MaximumStartsFromItsFloor) {
  for (const int threads : {1, 3, 20}) {
    const auto largest = [&](int size, double start) {
      return with_threads(threads, [&] { return parallel_max(size, start, [](int i) { return 1.0 * i; }); });
    };
    EXPECT_EQ(largest(10, 3), 9);
    EXPECT_EQ(largest(10, 30), 30);
    EXPECT_EQ(largest(0, -2), -2);
  }
}

/// EXACT.
TEST(Parallel, MaximaOfSeveral) {
  for (const int threads : {1, 3, 20}) {
    const auto both = with_threads(
        threads, [] { return parallel_max<2>(7, -1, [](int i) { return std::array{1.0 * i, -2.0 - i}; }); });
    EXPECT_EQ(both, (std::array{6.0, -1.0}));
  }
}

}  // namespace
}  // namespace pliant
