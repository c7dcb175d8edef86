#include "core/parallel.hpp"

#include <gtest/gtest.h>
#include <omp.h>

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

// EXACT: the sum has the same bits for any number of threads (DESIGN 5); numbers of very different size would betray
// another order.
TEST(Parallel, OrderedSumDoesNotDependOnThreads) {
  testing::Random random(4);
  for (const int size : {0, 1, 255, 256, 257, 10000}) {
    std::vector<double> values;
    for (int i = 0; i < size; ++i) values.push_back(random.uniform(-1, 1) * std::pow(10.0, random.uniform(0, 20)));
    const auto total = [&] { return ordered_sum(size, [&](int i) { return values[i]; }); };
    const double one = with_threads(1, total);
    for (const int threads : {2, 3, 7})
      EXPECT_EQ(with_threads(threads, total), one) << size << " values, " << threads << " threads";
  }
}

// EXACT.
TEST(Parallel, VisitsEveryIndexOnce) {
  for (const int threads : {1, 3}) {
    const auto visited = with_threads(threads, [] {
      std::vector<int> count(1000, 0);
      parallel_for(1000, [&](int i) { ++count[i]; });
      parallel_for_uneven(1000, 7, [&](int i) { ++count[i]; });
      return count;
    });
    for (int c : visited) EXPECT_EQ(c, 2);
  }
}

// EXACT.
TEST(Parallel, MaximumStartsFromItsFloor) {
  const auto value = [](int i) { return 1.0 * i; };
  EXPECT_EQ(parallel_max(10, 3, value), 9);
  EXPECT_EQ(parallel_max(10, 30, value), 30);
  EXPECT_EQ(parallel_max(0, -2, value), -2);
}

}  // namespace
}  // namespace pliant
