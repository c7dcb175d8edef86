#pragma once

#include <omp.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/loop_observer.hpp"

namespace pliant {

struct Share {
  int begin, end;
};

/// Contiguous iterations of a thread: as many as the others' or one more, or of the same cost.
inline Share share_of(const LoopShares& loop, int thread, int threads) {
  if (loop.cost) {
    const auto begin_of = [&](std::int64_t t) {
      const auto cost = static_cast<int>(t * loop.cost[loop.count] / threads);
      return static_cast<int>(std::lower_bound(loop.cost, loop.cost + loop.count, cost) - loop.cost);
    };
    return {begin_of(thread), thread + 1 == threads ? loop.count : begin_of(thread + 1)};
  }
  const int share = loop.count / threads, larger = loop.count % threads;
  const int begin = thread * share + std::min(thread, larger);
  return {begin, begin + share + (thread < larger ? 1 : 0)};
}

/// In a parallel region: calls body(i) for this thread's share. It is written by hand, because libomp formats strings
/// whenever an `omp for` begins: 7 to 15 % of the instructions of a small scene.
template <class Body>
void for_own_share(const LoopShares& loop, Body&& body, const LoopPlace& place) {
  const auto [begin, end] = share_of(loop, omp_get_thread_num(), omp_get_num_threads());
  const int chunk = loop_observer ? loop_observer->begin_loop(place, loop) : end - begin;
  for (int i = begin; i < end;) {
    for (const int stop = std::min(i + chunk, end); i < stop; ++i) body(i);
    if (loop_observer) loop_observer->end_chunk();
  }
}

inline void end_parallel_region() {
  if (loop_observer) loop_observer->end_region();
}

/// Runs body(i) for i in [0, count) on all threads, in contiguous equal shares. Iterations must write disjoint data.
template <class Body>
void parallel_for(int count, Body&& body, const LoopPlace& place = LoopPlace::current()) {
#pragma omp parallel
  for_own_share({count}, body, place);
  end_parallel_region();
}

/// The same in contiguous shares of equal cost; `cost`: [iterations + 1] sums of the cost of all iterations before.
template <class Body>
void parallel_for_by_cost(const std::vector<int>& cost, Body&& body, const LoopPlace& place = LoopPlace::current()) {
  const LoopShares loop{static_cast<int>(cost.size()) - 1, 0, cost.data()};
#pragma omp parallel
  for_own_share(loop, body, place);
  end_parallel_region();
}

/// Two loops that do not wait for each other: a thread that has finished its share of the first continues with the
/// second.
template <class Body, class OtherBody>
void parallel_for(int count, Body&& body, int other_count, OtherBody&& other_body,
                  const LoopPlace& place = LoopPlace::current()) {
#pragma omp parallel
  {
    for_own_share({count}, body, place);
    for_own_share({other_count}, other_body, place);
  }
  end_parallel_region();
}

/// As parallel_for, in chunks that threads take in turn: for work of uneven cost. Not schedule(dynamic): libomp 19,
/// whose threads steal from each other, sometimes aborts the program (llvm-project issues 86995 and 132164).
template <class Body>
void parallel_for_uneven(int count, int chunk, Body&& body, const LoopPlace& place = LoopPlace::current()) {
#pragma omp parallel
  {
    if (loop_observer) loop_observer->begin_loop(place, {count, chunk});
    const int stride = chunk * omp_get_num_threads();
    for (int begin = chunk * omp_get_thread_num(); begin < count; begin += stride) {
      for (int i = begin; i < std::min(begin + chunk, count); ++i) body(i);
      if (loop_observer) loop_observer->end_chunk();
    }
  }
  end_parallel_region();
}

/// Largest value of each entry of values(i), an array, at least `start`. A maximum does not depend on the order.
template <std::size_t size, class Values>
std::array<double, size> parallel_max(int count, double start, Values&& values,
                                      const LoopPlace& place = LoopPlace::current()) {
  double result[size];
  std::fill_n(result, size, start);
#pragma omp parallel reduction(max : result)
  for_own_share(
      {count},
      [&](int i) {
        const std::array<double, size> found = values(i);
        for (std::size_t k = 0; k < size; ++k) result[k] = std::max(result[k], found[k]);
      },
      place);
  end_parallel_region();
  return std::to_array(result);
}

/// The same for one value(i).
template <class Value>
double parallel_max(int count, double start, Value&& value, const LoopPlace& place = LoopPlace::current()) {
  return parallel_max<1>(count, start, [&](int i) { return std::array{value(i)}; }, place)[0];
}

/// Iterations in blocks of fixed size, whatever the number of threads: what blocks find is put together in their order.
struct Blocks {
  int iterations, size;

  int count() const { return (iterations + size - 1) / size; }
  Share operator[](int block) const { return {block * size, std::min((block + 1) * size, iterations)}; }
  template <class Visit>
  void for_each_in(int block, Visit&& visit) const {
    for (int i = block * size, end = (*this)[block].end; i < end; ++i) visit(i);
  }
};

/// Sum of value(i) whose rounding does not depend on the number of threads: in blocks, added in order.
template <int block = 256, class Value>
double ordered_sum(int count, Value&& value, const LoopPlace& place = LoopPlace::current()) {
  const Blocks blocks{count, block};
  thread_local std::vector<double> scratch;  // memory is allocated once
  std::vector<double>& partial = scratch;    // of the calling thread
  partial.assign(static_cast<std::size_t>(blocks.count()), 0.0);
  parallel_for(
      blocks.count(),
      [&](int b) { blocks.for_each_in(b, [&](int i) { partial[static_cast<std::size_t>(b)] += value(i); }); }, place);
  double total = 0;
  for (double p : partial) total += p;
  return total;
}

}  // namespace pliant
