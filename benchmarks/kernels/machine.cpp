// What the machine can do: fused multiply-adds, and reading from each level of the memory.
#include "benchmarks/kernels/machine.hpp"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/kernels/meter.hpp"
#include "core/lanes.hpp"

namespace pliant::kernels {
namespace {

double cache_bytes(int name, double otherwise) {
  const long size = sysconf(name);
  return size > 0 ? static_cast<double>(size) : otherwise;
}
const double cache_sizes[] = {cache_bytes(_SC_LEVEL1_DCACHE_SIZE, 32e3), cache_bytes(_SC_LEVEL2_CACHE_SIZE, 1e6),
                              cache_bytes(_SC_LEVEL3_CACHE_SIZE, 32e6)};

std::map<int, double> peaks;                         ///< by threads
std::map<std::pair<Level, int>, double> bandwidths;  ///< likewise

constexpr int chains = 16;       ///< two units of four cycles' latency need 8 at least
constexpr long rounds = 20'000;  ///< of all chains
constexpr double flops_of_rounds = 2.0 * lane_count * chains * rounds;

void multiply_and_add() {
  Lanes sums[chains];
  for (int k = 0; k < chains; ++k) sums[k] = broadcast(0.1 * k);
  Lanes factor = broadcast(0.999), summand = broadcast(1e-3);
  benchmark::DoNotOptimize(factor);
  benchmark::DoNotOptimize(summand);
  for (long i = 0; i < rounds; ++i)
    for (int k = 0; k < chains; ++k) sums[k] = sums[k] * factor + summand;
  for (Lanes& sum : sums) benchmark::DoNotOptimize(sum);
}

/// Numbers of each thread, which it wrote itself: so they lie in its own part of the memory.
class Numbers {
 public:
  Numbers(Level level, int threads) : lanes_(size_of(level, threads) / sizeof(Lanes) / sums * sums), of_(threads) {
#pragma omp parallel num_threads(threads)
    {
      auto& own = of_[static_cast<std::size_t>(omp_get_thread_num())];
      own = std::make_unique<Lanes[]>(lanes_);
      std::fill_n(own.get(), lanes_, broadcast(1));
    }
  }
  /// Adds up this thread's numbers so often.
  void add_up(long times) const {
    const Lanes* from = of_[static_cast<std::size_t>(omp_get_thread_num())].get();
    Lanes total[sums]{};
    for (long t = 0; t < times; ++t) {
      for (std::size_t i = 0; i < lanes_; i += sums)
        for (std::size_t k = 0; k < sums; ++k) total[k] += from[i + k];
      benchmark::ClobberMemory();
    }
    for (Lanes& t : total) benchmark::DoNotOptimize(t);
  }
  double bytes() const { return static_cast<double>(lanes_ * sizeof(Lanes)); }  ///< of a thread

 private:
  /// Half of the two inner caches; of the third, which others share, a part; of memory twice what it holds, or less
  /// where there is not so much.
  static std::size_t size_of(Level level, int threads) {
    const double available =
        static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
    const double l2 = cache_sizes[1], l3 = cache_sizes[2];
    switch (level) {
      case Level::l1:
        return static_cast<std::size_t>(cache_sizes[0] / 2);
      case Level::l2:
        return static_cast<std::size_t>(l2 / 2);
      case Level::l3:
        return static_cast<std::size_t>(std::clamp(l3 / 16, 2 * l2, 16 * l2) / threads);
      case Level::memory:
        return static_cast<std::size_t>(std::min(2 * l3, available / 4) / threads);
    }
    return 0;
  }

  static constexpr std::size_t sums = 8;
  std::size_t lanes_;
  std::vector<std::unique_ptr<Lanes[]>> of_;
};

/// Least seconds of many tries: some are disturbed.
template <class Action>
double least_seconds(Action&& action) {
  double least = 1e300;
  for (int attempt = 0; attempt < 25; ++attempt) {
    const auto start = std::chrono::steady_clock::now();
    action();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return least;
}

/// Sums of so many bytes take long beside the start of a team of threads.
long times_of(const Numbers& numbers) { return std::max(1L, static_cast<long>(4e6 / numbers.bytes())); }

void fma_peak(benchmark::State& state) {
  const Threads threads(state);
  for (auto _ : state)
#pragma omp parallel
    multiply_and_add();
  report(state, "fma", 0.5 * flops_of_rounds * threads.count, {flops_of_rounds * threads.count, 0});
}
BENCHMARK(fma_peak)->Name("machine/fma_peak")->Apply(one_and_two_threads);

void read_from(benchmark::State& state, Level level) {
  const Threads threads(state);
  const Numbers numbers(level, threads.count);
  const long times = times_of(numbers);
  for (auto _ : state)
#pragma omp parallel
    numbers.add_up(times);
  const double bytes = numbers.bytes() * static_cast<double>(times) * threads.count;
  report(state, "number", bytes / sizeof(double), {bytes / sizeof(double), bytes});
}
BENCHMARK_CAPTURE(read_from, l1, Level::l1)->Name("machine/read_bandwidth_l1")->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(read_from, l2, Level::l2)->Name("machine/read_bandwidth_l2")->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(read_from, l3, Level::l3)->Name("machine/read_bandwidth_l3")->Apply(one_and_two_threads);
BENCHMARK_CAPTURE(read_from, memory, Level::memory)->Name("machine/read_bandwidth_memory")->Apply(one_and_two_threads);

}  // namespace

Level level_of(double bytes_a_thread) {
  for (int level = 0; level < 3; ++level)
    if (bytes_a_thread <= cache_sizes[level]) return static_cast<Level>(level);
  return Level::memory;
}

double fma_peak(int threads) {
  if (!peaks.contains(threads))
    peaks[threads] = threads * flops_of_rounds / least_seconds([&] {
#pragma omp parallel num_threads(threads)
                       multiply_and_add();
                     });
  return peaks[threads];
}

double read_bandwidth(Level level, int threads) {
  const std::pair key(level, threads);
  if (!bandwidths.contains(key)) {
    const Numbers numbers(level, threads);
    const long times = times_of(numbers);
    bandwidths[key] = numbers.bytes() * static_cast<double>(times) * threads / least_seconds([&] {
#pragma omp parallel num_threads(threads)
                        numbers.add_up(times);
                      });
  }
  return bandwidths[key];
}

void take_note(const std::string& benchmark, int threads, double flop_rate, double read_rate) {
  if (benchmark.starts_with("machine/fma_peak")) peaks[threads] = std::max(fma_peak(threads), flop_rate);
  for (std::size_t level = 0; level < level_names.size(); ++level)
    if (benchmark.starts_with(std::string("machine/read_bandwidth_") + level_names[level])) {
      double& best = bandwidths[{static_cast<Level>(level), threads}];
      best = std::max(best, read_rate);
    }
}

}  // namespace pliant::kernels
