#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact/master_window.hpp"
#include "contact/segment_parts.hpp"
#include "contact/slave_arc.hpp"

namespace pliant {

/// Pairs of a slave segment, by its position in the pass, and a row of the master's window, one after the other.
class PairList {
 public:
  void clear() { count_ = 0; }
  void add(unsigned mask, int first_slave, int row) {
    if (slave_.size() < count_ + 2 * lane_count) slave_.resize(2 * count_ + 64), row_.resize(slave_.size());
    for (; mask != 0; mask &= mask - 1, ++count_)
      slave_[count_] = first_slave + std::countr_zero(mask), row_[count_] = row;
  }
  /// Pads the last eight, so that whole vectors can be loaded.
  void close() {
    if (count_ > 0)
      for (std::size_t i = count_; i % lane_count != 0; ++i) slave_[i] = slave_[0], row_[i] = row_[0];
  }
  int count() const { return static_cast<int>(count_); }
  LaneBits slaves(int i) const { return load(&slave_[static_cast<std::size_t>(i)]); }
  LaneBits rows(int i) const { return load(&row_[static_cast<std::size_t>(i)]); }

 private:
  std::size_t count_ = 0;
  std::vector<std::int64_t> slave_, row_;
};

/// Candidates of a half pass: slave segments that project on segments of the master, and in the vertex regions of its
/// nodes.
class SegmentCandidates {
 public:
  PairList segments, fans;

  /// `rows`: rows that can be touched. Finds every pair that has a part, and some that have none, row by row and slave
  /// by slave: sums do not depend on where arcs begin.
  void find(const SlaveArc& slaves, const MasterWindow& window, const Arc& rows, const GapRanges& ranges);

 private:
  std::vector<LaneBits, LineAllocator<LaneBits>> past_end_;  ///< slaves that reach past the end of the last row
};

}  // namespace pliant
