#pragma once

#include <omp.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace pliant {

/// In a parallel region: calls body(i) for this thread's share of [0, count). Shares are contiguous and differ by at
/// most one. It is written by hand, because libomp formats strings whenever an `omp for` begins: 7 to 15 % of the
/// instructions of a small scene.
template <class Body>
void for_own_share(int count, Body&& body) {
  const int threads = omp_get_num_threads(), thread = omp_get_thread_num();
  const int share = count / threads, larger = count % threads;
  const int begin = thread * share + std::min(thread, larger), end = begin + share + (thread < larger ? 1 : 0);
  for (int i = begin; i < end; ++i) body(i);
}

/// Runs body(i) for i in [0, count) on all threads, in contiguous equal shares. Iterations must write disjoint data.
template <class Body>
void parallel_for(int count, Body&& body) {
#pragma omp parallel
  for_own_share(count, body);
}

/// Two loops that do not wait for each other: a thread that has finished its share of the first continues with the
/// second.
template <class Body, class OtherBody>
void parallel_for(int count, Body&& body, int other_count, OtherBody&& other_body) {
#pragma omp parallel
  {
    for_own_share(count, body);
    for_own_share(other_count, other_body);
  }
}

/// As parallel_for, in chunks that threads take in turn: for work of uneven cost. Not schedule(dynamic): libomp 19,
/// whose threads steal from each other, sometimes aborts the program (llvm-project issues 86995 and 132164).
template <class Body>
void parallel_for_uneven(int count, int chunk, Body&& body) {
#pragma omp parallel
  {
    const int stride = chunk * omp_get_num_threads();
    for (int begin = chunk * omp_get_thread_num(); begin < count; begin += stride)
      for (int i = begin; i < std::min(begin + chunk, count); ++i) body(i);
  }
}

/// Largest value of each entry of values(i), an array, at least `start`. A maximum does not depend on the order.
template <std::size_t size, class Values>
std::array<double, size> parallel_max(int count, double start, Values&& values) {
  double result[size];
  std::fill_n(result, size, start);
#pragma omp parallel reduction(max : result)
  for_own_share(count, [&](int i) {
    const std::array<double, size> found = values(i);
    for (std::size_t k = 0; k < size; ++k) result[k] = std::max(result[k], found[k]);
  });
  return std::to_array(result);
}

/// The same for one value(i).
template <class Value>
double parallel_max(int count, double start, Value&& value) {
  return parallel_max<1>(count, start, [&](int i) { return std::array{value(i)}; })[0];
}

/// Whether holds(i) for some i.
template <class Holds>
bool parallel_any(int count, Holds&& holds) {
  return parallel_max(count, 0, [&](int i) { return holds(i) ? 1.0 : 0.0; }) > 0;
}

/// Sum of value(i) whose rounding does not depend on the number of threads: fixed blocks, added in order.
template <int block = 256, class Value>
double ordered_sum(int count, Value&& value) {
  const int blocks = (count + block - 1) / block;
  thread_local std::vector<double> scratch;  // memory is allocated once
  std::vector<double>& partial = scratch;    // of the calling thread
  partial.assign(static_cast<std::size_t>(blocks), 0.0);
  parallel_for(blocks, [&](int b) {
    for (int i = b * block; i < std::min(count, (b + 1) * block); ++i) partial[static_cast<std::size_t>(b)] += value(i);
  });
  double total = 0;
  for (double p : partial) total += p;
  return total;
}

}  // namespace pliant
