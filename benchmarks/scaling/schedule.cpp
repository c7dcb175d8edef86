#include "benchmarks/scaling/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"

namespace pliant::scaling {
namespace {

/// Sums of a loop's seconds up to any iteration, linear within chunks.
class Sums {
 public:
  explicit Sums(const LoopTimes& loop) : loop_(loop), sums_(loop.seconds.size() + 1) {
    std::partial_sum(loop.seconds.begin(), loop.seconds.end(), sums_.begin() + 1);
  }
  double total() const { return sums_.back(); }
  double until(double iteration) const {
    if (loop_.seconds.empty()) return 0;
    const auto c = std::min(static_cast<std::size_t>(iteration / loop_.chunk), loop_.seconds.size() - 1);
    const double begin = static_cast<double>(c) * loop_.chunk,
                 count = std::min<double>(loop_.chunk, loop_.count - begin);
    return sums_[c] + loop_.seconds[c] * std::min(1.0, (iteration - begin) / count);
  }
  /// The iteration before which so many seconds pass.
  double iteration_at(double seconds) const {
    const auto above = std::ranges::upper_bound(sums_, seconds);
    if (above == sums_.end()) return loop_.count;
    const auto c = static_cast<std::size_t>(above - sums_.begin()) - 1;
    const double begin = static_cast<double>(c) * loop_.chunk,
                 count = std::min<double>(loop_.chunk, loop_.count - begin);
    return begin + count * (seconds - sums_[c]) / loop_.seconds[c];
  }

 private:
  const LoopTimes& loop_;
  std::vector<double> sums_;
};

bool have_the_same_chunks(const std::vector<RegionTimes>& calls) {
  const RegionTimes& first = calls.front();
  return std::ranges::all_of(calls, [&](const RegionTimes& call) {
    return std::ranges::equal(call, first, [](const LoopTimes& a, const LoopTimes& b) { return a.has_chunks_of(b); });
  });
}

/// Medians of all chunks of every second call, from `first` on.
RegionTimes medians(const std::vector<RegionTimes>& calls, std::size_t first) {
  RegionTimes result = calls.front();
  std::vector<double> of_chunk;
  for (std::size_t l = 0; l < result.size(); ++l)
    for (std::size_t c = 0; c < result[l].seconds.size(); ++c) {
      of_chunk.clear();
      for (std::size_t call = first; call < calls.size(); call += 2) of_chunk.push_back(calls[call][l].seconds[c]);
      result[l].seconds[c] = median(of_chunk);
    }
  return result;
}

double slowest(const RegionTimes& loops, int threads, auto&& share) {
  std::vector<double> seconds(static_cast<std::size_t>(threads), 0.0);
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const std::vector<double> of_loop = share(l);
    for (std::size_t t = 0; t < seconds.size(); ++t) seconds[t] += of_loop[t];
  }
  return std::ranges::max(seconds);
}

Prediction predict(const RegionTimes& now, const RegionTimes& before) {
  Prediction result;
  for (const LoopTimes& loop : now) {
    result.one_thread += loop.total();
    for (double seconds : loop.seconds) result.worst_chunk = std::max(result.worst_chunk, seconds);
  }
  for (std::size_t i = 0; i < thread_counts.size(); ++i) {
    const int threads = thread_counts[i];
    result.shares[i] = slowest(now, threads, [&](std::size_t l) { return threads_of(now[l], threads); });
    result.by_cost[i] = slowest(now, threads, [&](std::size_t l) {
      const bool known = l < before.size() && before[l].count == now[l].count;
      return known ? threads_by_cost(now[l], before[l], threads) : threads_of(now[l], threads);
    });
  }
  return result;
}

}  // namespace

bool LoopTimes::has_chunks_of(const LoopTimes& other) const {
  return count == other.count && chunk == other.chunk && seconds.size() == other.seconds.size();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

Prediction play_back(const std::vector<RegionTimes>& calls) {
  if (calls.size() > 1 && have_the_same_chunks(calls)) return predict(medians(calls, 1), medians(calls, 0));
  std::vector<Prediction> single;
  for (std::size_t call = 0; call < calls.size(); ++call)
    single.push_back(predict(calls[call], call > 0 ? calls[call - 1] : RegionTimes()));
  const auto median_of = [&](auto&& value) {
    std::vector<double> values;
    for (const Prediction& one : single) values.push_back(value(one));
    return median(std::move(values));
  };
  Prediction result;
  result.one_thread = median_of([](const Prediction& one) { return one.one_thread; });
  result.worst_chunk = median_of([](const Prediction& one) { return one.worst_chunk; });
  for (std::size_t i = 0; i < thread_counts.size(); ++i) {
    result.shares[i] = median_of([&](const Prediction& one) { return one.shares[i]; });
    result.by_cost[i] = median_of([&](const Prediction& one) { return one.by_cost[i]; });
  }
  return result;
}

double LoopTimes::total() const { return std::reduce(seconds.begin(), seconds.end()); }

std::vector<double> threads_of(const LoopTimes& loop, int threads) {
  const Sums sums(loop);
  std::vector<double> result(static_cast<std::size_t>(threads));
  if (loop.turn > 0) {
    for (int begin = 0, turn = 0; begin < loop.count; begin += loop.turn, ++turn)
      result[static_cast<std::size_t>(turn % threads)] +=
          sums.until(std::min(begin + loop.turn, loop.count)) - sums.until(begin);
    return result;
  }
  for (int t = 0; t < threads; ++t) {
    const Share share = share_of(loop.shares(), t, threads);
    result[static_cast<std::size_t>(t)] = sums.until(share.end) - sums.until(share.begin);
  }
  return result;
}

std::vector<double> threads_by_cost(const LoopTimes& loop, const LoopTimes& before, int threads) {
  const Sums sums(loop), known(before);
  std::vector<double> result(static_cast<std::size_t>(threads));
  double begin = 0;
  for (int t = 0; t < threads; ++t) {
    const double end = std::round(known.iteration_at(known.total() * (t + 1) / threads));
    result[static_cast<std::size_t>(t)] = sums.until(end) - sums.until(begin);
    begin = end;
  }
  return result;
}

}  // namespace pliant::scaling
