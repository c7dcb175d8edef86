#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact/half_pass.hpp"
#include "contact/master_window.hpp"
#include "contact/segment_parts.hpp"

namespace pliant {

/// Index of position i of the pass in the arrays of the slave's outline.
inline int slave_index(const HalfPass& pass, int i) {
  const int index = pass.nodes.begin + i;
  return index - turn_of(index, pass.slave->count) * pass.slave->count;
}

/// Field on the nodes of an arc, contiguous, with room to load a whole vector at each node.
class ArcField {
 public:
  /// value(node, turn): Lanes of an outline array with its cyclic copies, from a node on, after a number of turns.
  template <class Value>
  void fill(const Arc& arc, const OutlineShape& outline, Value&& value) {
    const int nodes = arc.count + 1;
    if (const auto room = static_cast<std::size_t>(padded(nodes) + lane_count); values_.size() < room)
      values_.resize(room);
    for (int i = 0; i < nodes; i += lane_count) {
      const int turn = turn_of(arc.begin + i, outline.count);
      store(&values_[static_cast<std::size_t>(i)], value(arc.begin + i - turn * outline.count, turn));
    }
  }
  const double* data() const { return values_.data(); }

 private:
  std::vector<double> values_;
};

/// Segments of a slave that a half pass integrates over, from its first node on.
struct SlaveArc {
  int segments = 0;
  ArcField x, y;                ///< positions of nodes, m
  std::vector<double> lengths;  ///< of the reference or the current outline, m

  void fill(const HalfPass& pass) {
    segments = pass.segments;
    const Arc arc{pass.nodes.begin, segments};
    x.fill(arc, *pass.slave, [&](int node, int turn) {
      return load(pass.slave_x + node) + (pass.slave_shift.x() + turn * pass.slave->turn_shift);
    });
    y.fill(arc, *pass.slave, [&](int node, int) { return load(pass.slave_y + node) + pass.slave_shift.y(); });
    if (const auto room = static_cast<std::size_t>(padded(segments)); lengths.size() < room) lengths.resize(room);
    for (int i = 0; i < segments; i += lane_count) {
      Lanes length = load(&pass.slave->segment_length[static_cast<std::size_t>(slave_index(pass, i))]);
      if (pass.present_lengths) {
        const Lanes dx = load(x.data() + i + 1) - load(x.data() + i), dy = load(y.data() + i + 1) - load(y.data() + i);
        length = sqrt(dx * dx + dy * dy);
      }
      store(&lengths[static_cast<std::size_t>(i)], length);
    }
  }
};

/// Calls visit(pass, slave side) for both half passes, with the master's window filled.
template <class Visit>
void for_each_half_pass(const PairView& view, const ForceRuns& runs, Visit&& visit) {
  for (int slave_side = 0; slave_side < 2; ++slave_side) {
    if (view.contact_pair.slave_segments[slave_side] == 0) continue;
    HalfPass pass = make_half_pass(view, slave_side, runs);
    fill_window(view, 1 - slave_side);
    visit(pass, slave_side);
  }
}

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
