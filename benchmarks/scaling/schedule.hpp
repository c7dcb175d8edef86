#pragma once

#include <array>
#include <vector>

#include "core/loop_observer.hpp"

namespace pliant::scaling {

/// Seconds of the chunks of a loop, in order, on one thread.
struct LoopTimes {
  int count = 0;          ///< iterations
  int chunk = 1;          ///< iterations of each, the last may have fewer
  int turn = 0;           ///< LoopShares::turn
  std::vector<int> cost;  ///< LoopShares::cost; empty: none
  std::vector<double> seconds;

  LoopShares shares() const { return {count, turn, cost.empty() ? nullptr : cost.data()}; }
  double total() const;
  bool has_chunks_of(const LoopTimes& other) const;
};

/// Seconds of each of so many threads, as lib/core/parallel.hpp shares out the loop. The time of a chunk that two share
/// is split in the ratio of iterations.
std::vector<double> threads_of(const LoopTimes& loop, int threads);
/// The same for contiguous shares of equal cost, which is taken from `before`, an earlier run of the loop.
std::vector<double> threads_by_cost(const LoopTimes& loop, const LoopTimes& before, int threads);

/// The loops of a parallel region, one after the other without a barrier.
using RegionTimes = std::vector<LoopTimes>;

constexpr std::array thread_counts{1, 2, 4, 8, 16, 32, 64, 128};
using ByThreads = std::array<double, thread_counts.size()>;

/// A call of a region, s.
struct Prediction {
  double one_thread = 0, worst_chunk = 0;
  ByThreads shares{};   ///< of the slowest thread, in the schedule of the engine
  ByThreads by_cost{};  ///< of the slowest thread, with shares of equal cost that is known from other calls
};

/// Plays calls back. Where they all have the same chunks, each chunk counts with the median of its times: what
/// interrupts the processor now and then is no property of the loop. Else calls are played back one by one, and the
/// medians of their times taken.
Prediction play_back(const std::vector<RegionTimes>& calls);

double median(std::vector<double> values);

}  // namespace pliant::scaling
