#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/lanes.hpp"

namespace pliant {

/// Quadrature point on each of eight slave segments that project on segments of the master.
struct SegmentPoint {
  LaneBits hit;  ///< lanes that have a point; others have the weight 0
  Lanes s;       ///< coordinate on the slave segment
  Lanes gap;     ///< signed distance to the master's outline, negative inside, m
  Lanes weight;  ///< length times 1/2, the weight of a half pass, m
};
/// Integrals of a quantity over the same parts, alone and times s.
struct Moments {
  Lanes plain{}, times_s{};
  void add(Lanes value, Lanes s) { plain += value, times_s += s * value; }
};

/// Distance from a node at which a law is evaluated in the node's vertex region, and the weights of its values in
/// integrals over a part of the region.
struct FanPoint {
  LaneBits hit;
  Lanes s, gap;                  ///< as in SegmentPoint
  Lanes weight;                  ///< of dashpots, m; 0 outside
  Lanes normal_x, normal_y;      ///< outward normal of the master there; for dashpots
  Lanes energy_weight;           ///< for energies, m
  Lanes force_x[2], force_y[2];  ///< of a unit pressure on both nodes of the slave segment, m
  Moments of_limit;              ///< integrals of a unit shear limit, m
};

/// Integrals over a part of a vertex region that do not depend on the law.
struct FanShape {
  LaneBits hit{};
  Lanes weight[3]{};                   ///< length times powers of s and 1/2, the weight of a half pass, m
  Lanes normal_x[3]{}, normal_y[3]{};  ///< the same times the normal's components
  Moments gap{};                       ///< m2
};

template <class Visit>
concept WantsFans = requires(Visit& visit, const FanShape& shape) { visit.in_fan_of(shape); };

/// Range of gaps in which the tractions of a law are smooth, m. All of it is inside the master, or all of it outside.
struct GapRange {
  double low, high;
  bool is_inside() const { return high <= 0; }
};
struct GapRanges {
  std::array<GapRange, 4> ranges;
  int count = 0;
  double reach = 0;  ///< the largest gap
  const GapRange* begin() const { return ranges.data(); }
  const GapRange* end() const { return ranges.data() + count; }
  double deepest() const { return -ranges[0].low; }
};

/// Smooth ranges of a law with kinks(), down to a depth.
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

/// Function that is linear along each segment, by its values at the ends.
struct Linear {
  Lanes at0, at1;
  Linear operator-(const Linear& o) const { return {at0 - o.at0, at1 - o.at1}; }
  Lanes at(Lanes s) const { return at0 + s * (at1 - at0); }
};
inline Linear select(LaneBits mask, const Linear& yes, const Linear& no) {
  return {select(mask, yes.at0, no.at0), select(mask, yes.at1, no.at1)};
}

/// Finds where such a function has values in an interval.
class Levels {
 public:
  explicit Levels(const Linear& f)
      : at0_(f.at0), flat_(f.at1 == f.at0), inverse_(1.0 / select(flat_, broadcast(1), f.at1 - f.at0)) {}
  /// Least and largest s; empty if the second is less.
  struct Between {
    Lanes low, high;
  };
  Between between(double low, double high) const {
    const Lanes first = (low - at0_) * inverse_, second = (high - at0_) * inverse_;
    const LaneBits all = (at0_ >= low) & (at0_ <= high);
    return {select(flat_, select(all, Lanes{}, broadcast(1)), min(first, second)),
            select(flat_, select(all, broadcast(1), Lanes{}), max(first, second))};
  }

 private:
  Lanes at0_;
  LaneBits flat_;
  Lanes inverse_;
};

/// The part [low, high] of each of eight segments; empty unless high is more than low.
struct Span8 {
  Lanes low{}, high = broadcast(1);

  /// Keeps the part where a linear function is not negative. Where the function is 0 all along the segment, lanes in
  /// `leaves_zero` keep nothing, because another segment takes that part.
  void keep(const Linear& f, LaneBits leaves_zero = LaneBits{}) {
    const Lanes change = f.at1 - f.at0, root = -f.at0 / select(change != 0.0, change, broadcast(1));
    low = max(low, select(change > 0.0, root, low));
    high = min(high, select(change < 0.0, root, high));
    high = select((change == 0.0) & ((f.at0 < 0.0) | (leaves_zero & (f.at0 == 0.0))), broadcast(-1), high);
  }
  /// Lanes with a part. Parts shorter than `rounding` of the segment are left by clips that should meet, and do not
  /// count.
  LaneBits some() const { return high - low > rounding; }
  static constexpr double rounding = 1e-12;
};

/// Several such parts of each segment, in any order. `memory` may grow; it holds one such object at a time.
class Spans8 {
 public:
  Spans8(const Span8& all, std::vector<Span8>& memory) : spans_(memory) {
    if (spans_.empty()) spans_.resize(16);
    spans_[0] = all;
  }

  /// Removes a part from each segment, which may leave two.
  void remove(const Span8& part) {
    const LaneBits some = part.some();
    if (!any(some)) return;
    for (std::size_t i = count_; i-- > 0;) {
      const Span8 all = spans_[i];
      const LaneBits cut = some & all.some() & (part.low < all.high) & (part.high > all.low);
      if (!any(cut)) continue;
      spans_[i].high = select(cut, min(all.high, part.low), all.high);
      add(cut, {max(all.low, part.high), all.high});
    }
  }
  const Span8* begin() const { return spans_.data(); }
  const Span8* end() const { return spans_.data() + count_; }

 private:
  /// Adds a part at the first free position of each lane.
  void add(LaneBits which, const Span8& part) {
    LaneBits left = which & part.some();
    for (std::size_t i = 0; any(left); ++i) {
      if (i == spans_.size()) spans_.emplace_back();
      if (i == count_) spans_[count_++].high = broadcast(-1);
      const LaneBits here = left & ~spans_[i].some();
      spans_[i] = {select(here, part.low, spans_[i].low), select(here, part.high, spans_[i].high)};
      left &= ~here;
    }
  }

  std::vector<Span8>& spans_;
  std::size_t count_ = 1;
};

/// Parts of eight slave segments, each within a range of gaps, packed so that most lanes have one.
class PackedParts {
 public:
  struct Eight {
    LaneBits hit;
    Span8 span;
    Lanes low, high;  ///< range of gaps, m
  };

  void clear() { count_ = 0; }
  void put(LaneBits hit, const Span8& part, const GapRange& range) {
    LaneBits left = hit & part.some();
    for (std::size_t i = 0; any(left); ++i) {
      if (i == eights_.size()) eights_.emplace_back();
      if (i == count_) eights_[count_++] = Eight{};
      Eight& eight = eights_[i];
      const LaneBits here = left & ~eight.hit;
      eight.hit |= here;
      eight.span = {select(here, part.low, eight.span.low), select(here, part.high, eight.span.high)};
      eight.low = select(here, broadcast(range.low), eight.low);
      eight.high = select(here, broadcast(range.high), eight.high);
      left &= ~here;
    }
  }
  const Eight* begin() const { return eights_.data(); }
  const Eight* end() const { return eights_.data() + count_; }

 private:
  std::vector<Eight> eights_;
  std::size_t count_ = 0;
};

/// Parts of eight slave segments in the vertex region outside a node, each in a range of gaps.
struct FanParts {
  LaneBits hit;
  Span8 span;
  Lanes low, high;       ///< range of gaps, m
  Lanes x0, y0, dx, dy;  ///< first end of the slave segment relative to the node, and its vector, m
  Lanes counted_length;  ///< of the whole slave segment, reference or current, m
};

/// Calls visit.in_fan(FanPoint) and, where present, visit.in_fan_of(FanShape) for such parts.
///
/// Normals rotate from one side of a corner to the other, over almost no length if a segment passes close by. Therefore
/// the integrals of tractions a + b r times hat functions are evaluated in closed form, from the tractions at two
/// distances r. With u along the segment from the foot of the node and m the node's distance, r^2 = m^2 + u^2.
template <class Visit>
void visit_fan_forces(const FanParts& of, Visit& visit) {
  const Lanes length = sqrt(of.dx * of.dx + of.dy * of.dy), ex = of.dx / length, ey = of.dy / length;
  const Lanes u0 = of.x0 * ex + of.y0 * ey;
  const Lanes mx = of.x0 - u0 * ex, my = of.y0 - u0 * ey, m2 = mx * mx + my * my;
  const Lanes a = u0 + select(of.hit, of.span.low, Lanes{}) * length,
              b = u0 + select(of.hit, of.span.high, Lanes{}) * length;
  const Lanes ra = sqrt(m2 + a * a), rb = sqrt(m2 + b * b);
  // Integrals of 1/r, u/r and u^2/r. a and b are on the same side of the foot.
  const LaneBits before = a + b < 0.0;
  const Lanes near_end = select(before, rb - b, ra + a), far_end = select(before, ra - a, rb + b);
  const LaneBits apart = of.hit & (near_end > 0.0);
  const Lanes ratio = far_end / select(apart, near_end, broadcast(1));
  Lanes q0{};
  for (int lane = 0; lane < lane_count; ++lane)
    if (apart[lane]) q0[lane] = std::log(ratio[lane]);
  const Lanes q1 = rb - ra, q2 = 0.5 * (b * rb - a * ra - m2 * q0);
  const Lanes p0 = b - a, p1 = 0.5 * (b * b - a * a), p2 = (b * b * b - a * a * a) * (1.0 / 3);
  // Integrals of n and r n, alone and times u.
  const Lanes n_x = mx * q0 + ex * q1, n_y = my * q0 + ey * q1, un_x = mx * q1 + ex * q2, un_y = my * q1 + ey * q2;
  const Lanes rn_x = mx * p0 + ex * p1, rn_y = my * p0 + ey * p1, urn_x = mx * p1 + ex * p2, urn_y = my * p1 + ey * p2;
  const Lanes scale = select(of.hit, 0.5 * of.counted_length / length, Lanes{}), inverse = 1.0 / length;
  const Lanes r_integral = 0.5 * (b * rb - a * ra + m2 * q0), r2_integral = m2 * p0 + p2;
  // Integrals times s and s^2, where s = (u - u0)/length.
  const Lanes ru = (rb * rb * rb - ra * ra * ra) * (1.0 / 3), r_times_s = (ru - u0 * r_integral) * inverse,
              times_s = (p1 - u0 * p0) * inverse;
  if constexpr (WantsFans<Visit>) {
    const Lanes q3 = b * b * rb - a * a * ra - 2.0 * ru, twice = 2.0 * u0, square = u0 * u0,
                inverse2 = inverse * inverse;
    FanShape shape{of.hit};
    shape.weight[0] = scale * p0, shape.weight[1] = scale * times_s;
    shape.weight[2] = scale * (p2 - twice * p1 + square * p0) * inverse2;
    const auto times = [&](Lanes* to, Lanes n, Lanes un, Lanes uun) {
      to[0] = scale * n, to[1] = scale * (un - u0 * n) * inverse;
      to[2] = scale * (uun - twice * un + square * n) * inverse2;
    };
    times(shape.normal_x, n_x, un_x, mx * q2 + ex * q3);
    times(shape.normal_y, n_y, un_y, my * q2 + ey * q3);
    shape.gap = {scale * r_integral, scale * r_times_s};
    visit.in_fan_of(shape);
  }
  // Tractions are interpolated from the first and the last of three distances, energies from all three.
  const Lanes middle = 0.5 * (of.low + of.high), half = select(of.hit, 0.25 * (of.high - of.low), broadcast(1));
  for (const int k : {-1, 0, 1}) {
    const double to_p = k == 0 ? -1 : -k, to_q = k == 0 ? 1 : -2 * k;  // offsets of the other two
    const Lanes own = middle + k * half, p = own + to_p * half, q = own + to_q * half;
    FanPoint point{of.hit, {}, own, {}, {}, {}, {}, {}, {}, {}};
    point.energy_weight = scale / ((to_p * to_q) * half * half) * (r2_integral - (p + q) * r_integral + p * q * p0);
    if (k != 0) {
      const Lanes factor = scale / (to_q * half);
      const Lanes x = factor * (q * n_x - rn_x), y = factor * (q * n_y - rn_y), ux = factor * (q * un_x - urn_x),
                  uy = factor * (q * un_y - urn_y);
      point.force_x[1] = (ux - u0 * x) * inverse, point.force_y[1] = (uy - u0 * y) * inverse;
      point.force_x[0] = x - point.force_x[1], point.force_y[0] = y - point.force_y[1];
      point.of_limit = {factor * (q * p0 - r_integral), factor * (q * times_s - r_times_s)};
    }
    visit.in_fan(point);
  }
}

}  // namespace pliant
