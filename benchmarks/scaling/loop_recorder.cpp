#include "benchmarks/scaling/loop_recorder.hpp"

#include <algorithm>
#include <fstream>
#include <utility>

namespace pliant::scaling {
namespace {

constexpr double least_chunk = 1e-5;  ///< s: reading the clock breaks into the work of a processor that looks ahead
constexpr int most_chunks = 8192;     ///< of a loop, so that all fit into memory

/// Seconds between two readings of the clock that follow each other.
double clock_cost() {
  using Clock = std::chrono::steady_clock;
  constexpr int readings = 1000;
  const auto start = Clock::now();
  for (int i = 0; i < readings; ++i) (void)Clock::now();
  return std::chrono::duration<double>(Clock::now() - start).count() / readings;
}

}  // namespace

LoopRecorder::Key key_of(const LoopPlace& place) { return {place.file_name(), place.line()}; }

double LoopRecorder::lap() {
  static const double cost = clock_cost();
  const auto now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - std::exchange(mark_, now)).count();
  return std::max(0.0, seconds - cost);
}

void LoopRecorder::begin_step() { mark_ = Clock::now(); }

int LoopRecorder::begin_loop(const LoopPlace& place, const LoopShares& shares) {
  const auto [count, turn, cost] = shares;
  if (!std::exchange(in_region_, true)) {
    const double serial = lap();
    key_ = key_of(place);
    RegionCalls& region = regions_[key_];
    region.place = place;
    region.calls.emplace_back(), region.serial.push_back(serial);
  }
  RegionTimes& loops = regions_[key_].calls.back();
  int chunk = turn > 0 ? turn : 1;
  const auto known = of_iteration_.find({key_, loops.size()});
  if (turn == 0 && known != of_iteration_.end())
    chunk = std::clamp(static_cast<int>(least_chunk / known->second), 1 + count / most_chunks, 1 + count / 128);
  loops.push_back({count, chunk, turn, {}, {}});
  if (cost) loops.back().cost.assign(cost, cost + count + 1);
  loops.back().seconds.reserve(static_cast<std::size_t>(count / chunk + 1));
  mark_ = Clock::now();
  return chunk;
}

void LoopRecorder::end_chunk() { regions_[key_].calls.back().back().seconds.push_back(lap()); }

void LoopRecorder::end_region() {
  in_region_ = false;
  const RegionTimes& loops = regions_[key_].calls.back();
  for (std::size_t l = 0; l < loops.size(); ++l)
    if (loops[l].total() > 0) of_iteration_.try_emplace({key_, l}, loops[l].total() / loops[l].count);
  mark_ = Clock::now();
}

void LoopRecorder::end_step() { serial_at_end_.push_back(lap()); }

void LoopRecorder::forget() {
  regions_.clear();
  serial_at_end_.clear();
}

int PageCounter::begin_loop(const LoopPlace& place, const LoopShares& shares) {
  if (!std::exchange(in_region_, true)) key_ = key_of(place), clear_touched();
  return std::max(1, shares.count);
}

void PageCounter::end_region() {
  bytes_[key_] += touched();
  in_region_ = false;
}

void clear_touched() { std::ofstream("/proc/self/clear_refs") << 1; }

double touched() {
  std::ifstream file("/proc/self/smaps_rollup");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("Referenced:")) return 1024 * std::stod(line.substr(11));
  return 0;
}

}  // namespace pliant::scaling
