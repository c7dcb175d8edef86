#pragma once

#include <array>

#include "core/lanes.hpp"

namespace pliant {

/// Eight slave segments, from x0, y0 to x1, y1; a point on one is at s in [0, 1].
struct SlaveSegments {
  Lanes x0, y0, x1, y1;  ///< m
  Lanes length;          ///< that counts, of the reference outline or the present one, m
  LaneBits valid;
};

/// A point of the quadrature on each of eight slave segments, all of them nearest to the same segment of the master, or
/// to the same node.
struct QuadraturePoint {
  LaneBits hit;  ///< which of the eight have one; others have the weight 0
  int row;       ///< of the window: the master's segment; of a node the one that begins there, or ends at the last
  bool of_node;  ///< the nearest place is a node: at xi = 0, or 1 at the last one
  Lanes s, xi;   ///< on the slave's segment, on the master's
  Lanes gap;     ///< signed distance to the master's outline, negative inside, m
  Lanes normal_x, normal_y;  ///< of the master there, outward
  Lanes weight;              ///< length times 1/2, as each of the two passes has half, m
  Lanes energy_weight;       ///< the same for energies: in a fan outside forces and energies have points of their own
  Lanes force_x[2], force_y[2];  ///< of a unit pressure on the two nodes of the slave segment, m
  Lanes depth;                   ///< the most that the slave segment penetrates nearby, m
};

/// A range of gaps within which the tractions of a law are smooth, m. All of it is inside the master or outside.
struct GapRange {
  double low, high;
};
struct GapRanges {
  std::array<GapRange, 4> ranges;
  int count = 0;
  double reach = 0;  ///< the largest gap
  const GapRange* begin() const { return ranges.data(); }
  const GapRange* end() const { return ranges.data() + count; }
};

/// Of a law with kinks(), down to a depth.
template <class Law>
GapRanges gap_ranges(const Law& law, double depth) {
  GapRanges result;
  double low = -depth;
  const auto up_to = [&](double high) {
    if (high <= low) return;
    result.ranges[result.count++] = {low, high};
    low = result.reach = high;
  };
  for (const double kink : law.kinks()) {
    if (kink > 0) up_to(0);
    up_to(kink);
  }
  return result;
}

/// Of a function that is linear along each segment.
struct Linear {
  Lanes at0, at1;
  Linear operator-(const Linear& o) const { return {at0 - o.at0, at1 - o.at1}; }
  Lanes at(Lanes s) const { return at0 + s * (at1 - at0); }
};

/// Coordinates against a segment of the master: along it, and outward.
struct Beside {
  Linear along, height;
  double length;
};

/// The part [low, high] of each of eight segments; none where high is not more than low.
struct Span8 {
  Lanes low{}, high = broadcast(1);

  /// Keeps where a function is not negative that is linear along the segment, from its values at both ends.
  void keep(Lanes at0, Lanes at1) {
    const Lanes change = at1 - at0, root = -at0 / select(change != 0.0, change, broadcast(1));
    low = max(low, select(change > 0.0, root, low));
    high = min(high, select(change < 0.0, root, high));
    high = select((change == 0.0) & (at0 < 0.0), broadcast(-1), high);
  }
  /// Whether there is one: what is shorter than `rounding` of the segment is left by clips that should meet.
  LaneBits some() const { return high - low > rounding; }
  static constexpr double rounding = 1e-12;
};

/// Several such parts, one behind the other in each lane.
class Spans8 {
 public:
  explicit Spans8(const Span8& all) : spans_{all} {}

  /// Takes a part out of each, which may leave two.
  void remove(const Span8& part) {
    if (!any(part.some())) return;
    for (int i = count_ - 1; i >= 0; --i) {
      const Span8 all = spans_[i];
      const LaneBits cut = part.some() & (part.low < all.high) & (part.high > all.low);
      if (!any(cut)) continue;
      const Span8 before{all.low, select(cut, min(all.high, part.low), all.high)},
          after{max(all.low, part.high), select(cut, all.high, broadcast(-1))};
      spans_[i] = before;
      if (any(after.some()) && count_ < static_cast<int>(spans_.size())) spans_[count_++] = after;
    }
  }
  const Span8* begin() const { return spans_.data(); }
  const Span8* end() const { return spans_.data() + count_; }

 private:
  std::array<Span8, 8> spans_;
  int count_ = 1;
};

}  // namespace pliant
