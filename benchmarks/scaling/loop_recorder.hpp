#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/scaling/schedule.hpp"
#include "core/loop_observer.hpp"

namespace pliant::scaling {

/// All calls of a parallel region in the recorded steps.
struct RegionCalls {
  LoopPlace place;
  std::vector<RegionTimes> calls;
  std::vector<double> serial;  ///< s, from the end of the region before to the begin of this one
};

/// Times the chunks of all parallel loops on one thread.
class LoopRecorder : public LoopObserver {
 public:
  void begin_step();
  void end_step();
  int begin_loop(const LoopPlace& place, const LoopShares& shares) override;
  void end_chunk() override;
  void end_region() override;

  using Key = std::pair<std::string, unsigned>;  ///< file and line
  const std::map<Key, RegionCalls>& regions() const { return regions_; }
  const std::vector<double>& serial_at_end() const { return serial_at_end_; }  ///< s after the last region of each step
  int steps() const { return static_cast<int>(serial_at_end_.size()); }
  void forget();  ///< what was recorded; the length of chunks stays

 private:
  using Clock = std::chrono::steady_clock;
  double lap();  ///< s since the last call, less what the clock takes

  std::map<Key, RegionCalls> regions_;
  /// Time of an iteration of each loop of a region, the first time, s.
  std::map<std::pair<Key, std::size_t>, double> of_iteration_;
  Key key_;
  bool in_region_ = false;
  std::vector<double> serial_at_end_;
  Clock::time_point mark_;
};

/// Counts the bytes of the pages that each region touches, by what the system notes of pages (man 5 proc, clear_refs).
class PageCounter : public LoopObserver {
 public:
  explicit PageCounter(std::map<LoopRecorder::Key, double>& bytes) : bytes_(bytes) {}
  int begin_loop(const LoopPlace& place, const LoopShares& shares) override;
  void end_chunk() override {}
  void end_region() override;

 private:
  std::map<LoopRecorder::Key, double>& bytes_;
  LoopRecorder::Key key_;
  bool in_region_ = false;
};

/// Bytes of all pages touched since clear_touched(); 0 where the system does not tell.
void clear_touched();
double touched();

LoopRecorder::Key key_of(const LoopPlace& place);

}  // namespace pliant::scaling
