#pragma once

#include <benchmark/benchmark.h>
#include <omp.h>

#include <string>

namespace pliant::kernels {

/// What an iteration of a kernel cannot do without. Flops are counted in its loops, a fused multiply-add as two,
/// comparisons and selections not; divisions and roots as one. Bytes are compulsory traffic: all that it reads and
/// writes, each once, as if caches held everything in between.
struct Work {
  double flops = 0, bytes = 0;
  Work operator+(const Work& other) const { return {flops + other.flops, bytes + other.bytes}; }
  friend Work operator*(double n, const Work& work) { return {n * work.flops, n * work.bytes}; }
};

/// The threads that a benchmark's argument asks for, while this lives.
struct Threads {
  explicit Threads(const benchmark::State& state) : count(static_cast<int>(state.range(0))) {
    omp_set_num_threads(count);
  }
  Threads(const Threads&) = delete;
  ~Threads() { omp_set_num_threads(omp_get_num_procs()); }
  int count;
};

/// All benchmarks have the threads as their argument, and are timed by the clock on the wall.
inline void one_thread(benchmark::internal::Benchmark* b) {
  b->ArgName("threads")->Arg(1)->UseRealTime()->Unit(benchmark::kMicrosecond);
}
inline void one_and_two_threads(benchmark::internal::Benchmark* b) {
  one_thread(b);
  if (omp_get_num_procs() > 1) b->Arg(2);
}

/// Counters of an iteration: flops, bytes, threads, units, and time a unit in ns.
inline void report(benchmark::State& state, const std::string& unit, double units, const Work& work) {
  using benchmark::Counter;
  state.counters["flops"] = work.flops;
  state.counters["bytes"] = work.bytes;
  state.counters["threads"] = static_cast<double>(state.range(0));
  state.counters[unit + "s"] = units;
  state.counters["ns_a_" + unit] = Counter(1e-9 * units, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

}  // namespace pliant::kernels
