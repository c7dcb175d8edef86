#include "benchmarks/scaling/schedule.hpp"

#include <gtest/gtest.h>

#include "benchmarks/scaling/loop_recorder.hpp"
#include "core/parallel.hpp"

namespace pliant::scaling {
namespace {

using Seconds = std::vector<double>;

// EXACT: the engine gives the first threads the longer shares (lib/core/parallel.hpp).
TEST(Schedule, EqualSharesOfIterations) {
  const LoopTimes loop{5, 1, 0, {}, {1, 2, 4, 8, 16}};
  EXPECT_EQ(threads_of(loop, 1), Seconds{31});
  EXPECT_EQ(threads_of(loop, 2), (Seconds{7, 24}));
  EXPECT_EQ(threads_of(loop, 3), (Seconds{3, 12, 16}));
  EXPECT_EQ(threads_of(loop, 8), (Seconds{1, 2, 4, 8, 16, 0, 0, 0}));
}

// EXACT
TEST(Schedule, SharesSplitAChunkByIterations) {
  const LoopTimes loop{10, 4, 0, {}, {4, 8, 6}};  // 1 each, 2 each, 3 each
  EXPECT_EQ(threads_of(loop, 2), (Seconds{6, 12}));
  EXPECT_EQ(threads_of(loop, 5), (Seconds{2, 2, 4, 4, 6}));
}

// EXACT: a share begins with the first iteration before which its part of all cost lies.
TEST(Schedule, SharesOfEqualCost) {
  const LoopTimes loop{5, 1, 0, {0, 4, 5, 6, 7, 8}, {1, 2, 4, 8, 16}};
  EXPECT_EQ(threads_of(loop, 1), Seconds{31});
  EXPECT_EQ(threads_of(loop, 2), (Seconds{1, 30}));
  EXPECT_EQ(threads_of(loop, 4), (Seconds{1, 0, 6, 24}));
}

// EXACT
TEST(Schedule, ThreadsTakeTurns) {
  const LoopTimes loop{7, 2, 2, {}, {1, 2, 4, 8}};
  EXPECT_EQ(threads_of(loop, 2), (Seconds{5, 10}));
  EXPECT_EQ(threads_of(loop, 3), (Seconds{9, 2, 4}));
}

// EXACT: what was costly before is shared out; this time it is not.
TEST(Schedule, SharesOfEqualCostFollowTheTimeBefore) {
  const LoopTimes before{6, 1, 0, {}, {5, 1, 1, 1, 1, 1}}, now{6, 1, 0, {}, {5, 1, 1, 1, 1, 1}},
      changed{6, 1, 0, {}, {1, 1, 1, 1, 1, 5}};
  EXPECT_EQ(threads_by_cost(now, before, 2), (Seconds{5, 5}));
  EXPECT_EQ(threads_by_cost(changed, before, 2), (Seconds{1, 9}));
}

// EXACT
TEST(Schedule, EmptyLoopsTakeNoTime) {
  EXPECT_EQ(threads_of({0, 1, 0, {}, {}}, 3), (Seconds{0, 0, 0}));
  EXPECT_EQ(threads_by_cost({0, 1, 0, {}, {}}, {0, 1, 0, {}, {}}, 2), (Seconds{0, 0}));
}

// EXACT: a chunk that was slow once is not slow; one that always is counts. Cost is known from the calls between.
TEST(Schedule, InterruptionsDoNotCount) {
  const auto call = [](Seconds seconds) { return RegionTimes{{4, 1, 0, {}, std::move(seconds)}}; };
  const Prediction found = play_back({call({3, 1, 1, 1}), call({3, 1, 9, 1}), call({3, 1, 1, 1}), call({3, 9, 1, 1}),
                                      call({3, 1, 1, 1}), call({3, 1, 1, 1})});
  EXPECT_EQ(found.one_thread, 6);
  EXPECT_EQ(found.worst_chunk, 3);
  EXPECT_EQ(found.shares[1], 4);
  EXPECT_EQ(found.by_cost[1], 3);
}

// EXACT: calls of different length are played back one by one.
TEST(Schedule, CallsOfOtherLengthAreTakenOneByOne) {
  const std::vector<RegionTimes> calls{{{1, 1, 0, {}, {5}}}, {{2, 1, 0, {}, {1, 3}}}, {{3, 1, 0, {}, {1, 1, 4}}}};
  const Prediction found = play_back(calls);
  EXPECT_EQ(found.one_thread, 5);  // of 5, 4, 6
  EXPECT_EQ(found.shares[1], 4);   // of 5, 3, 4
}

// EXACT: each iteration runs once under observation, whatever the chunks, and regions are told apart by their place.
TEST(LoopRecorder, SeesAllLoopsOfAStep) {
  LoopRecorder recorder;
  std::vector<int> ran(1000, 0);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  loop_observer = &recorder;
  for (int step = 0; step < 3; ++step) {
    recorder.begin_step();
    parallel_for(1000, [&](int i) { ++ran[i]; });
    parallel_for_uneven(1000, 7, [&](int i) { ++ran[i]; });
    parallel_for(10, [&](int i) { ++ran[i]; }, 0, [&](int) {});
    recorder.end_step();
  }
  loop_observer = nullptr;
  omp_set_num_threads(before);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(ran[i], i < 10 ? 9 : 6);
  ASSERT_EQ(recorder.regions().size(), 3);
  long iterations = 0;
  for (const auto& [key, region] : recorder.regions()) {
    ASSERT_EQ(region.calls.size(), 3);
    for (const RegionTimes& call : region.calls)
      for (const LoopTimes& loop : call) {
        iterations += loop.count;
        EXPECT_EQ(loop.seconds.size(), (loop.count + loop.chunk - 1) / loop.chunk);
      }
  }
  EXPECT_EQ(iterations, 3 * 2010);
}

}  // namespace
}  // namespace pliant::scaling
