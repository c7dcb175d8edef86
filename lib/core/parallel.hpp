#pragma once

#include <algorithm>
#include <vector>

namespace pliant {

/// Runs body(i) for i in [0, count) on all threads, in contiguous equal shares. Iterations must write disjoint data.
template <class Body>
void parallel_for(int count, Body&& body) {
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) body(i);
}

/// As parallel_for, in chunks handed out as threads become free: for work of uneven cost.
template <class Body>
void parallel_for_uneven(int count, int chunk, Body&& body) {
#pragma omp parallel for schedule(dynamic, chunk)
  for (int i = 0; i < count; ++i) body(i);
}

/// Largest value(i), at least `start`. A maximum does not depend on the order.
template <class Value>
double parallel_max(int count, double start, Value&& value) {
  double result = start;
#pragma omp parallel for schedule(static) reduction(max : result)
  for (int i = 0; i < count; ++i) result = std::max(result, value(i));
  return result;
}

/// Sum of value(i) whose rounding does not depend on the number of threads: fixed blocks, added in order.
template <int block = 256, class Value>
double ordered_sum(int count, Value&& value) {
  const int blocks = (count + block - 1) / block;
  std::vector<double> partial(static_cast<std::size_t>(blocks), 0.0);
  parallel_for(blocks, [&](int b) {
    for (int i = b * block; i < std::min(count, (b + 1) * block); ++i) partial[static_cast<std::size_t>(b)] += value(i);
  });
  double total = 0;
  for (double p : partial) total += p;
  return total;
}

}  // namespace pliant
