#pragma once

#include "contact/segment_candidates.hpp"
#include "contact/segment_cuts.hpp"
#include "contact/segment_parts.hpp"

namespace pliant {

/// Quadrature of one half pass: slave segments are split where the nearest part of the master's outline changes, and
/// where the law is not smooth; each part has quadrature points.
///
/// On a segment of the master the signed distance is linear along the slave's segment. Two Gauss points then
/// integrate the tractions of piecewise linear laws times hat functions without error. In a vertex region inside, the
/// traction is that of a linear spring to the node, also without error. Outside, for laws with a reach, integrals are
/// in closed form unless three points suffice.
///
/// Pairs are handled eight at a time. For each eight: visit.begin(SegmentPairs, xi), then
/// visit.on_segment(SegmentPoint) for some points, or visit.in_fan(FanPoint) for some distances and, where present,
/// visit.in_fan_of(FanShape) for parts of a vertex region, then visit.end(); xi: coordinate on the master's segment,
/// linear in s; 0 or 1 for nodes.
class SegmentQuadrature {
 public:
  template <class Visit>
  void run(const HalfPass& pass, const MasterWindow& window, const GapRanges& ranges, Visit&& visit) {
    deepest_ = Lanes{};
    slaves_.fill(pass);
    candidates_.find(slaves_, window, pass.rows, ranges);
    const SegmentCuts cuts(window, ranges, spans_);
    const PairList& segments = candidates_.segments;
    for (int i = 0; i < segments.count(); i += lane_count) {
      const SegmentPairs pairs =
          cuts.pairs(slaves_, segments.slaves(i), segments.rows(i), first_lanes(segments.count() - i), false);
      parts_.clear();
      cuts.add_segment_parts(pairs, parts_);
      visit_segments(pairs, visit);
    }
    const PairList& fans = candidates_.fans;
    for (int i = 0; i < fans.count(); i += lane_count) {
      const LaneBits at = fans.rows(i), at_end = at == pass.rows.end();
      const SegmentPairs pairs = cuts.pairs(slaves_, fans.slaves(i), at + at_end, first_lanes(fans.count() - i), true);
      const NodeLanes nodes = cuts.nodes(at);
      parts_.clear();
      cuts.in_fans(pairs, nodes, at, parts_);
      visit_fans(pairs, nodes, select(at_end, broadcast(1), Lanes{}), visit);
    }
  }
  /// Largest penetration of slave segments, m.
  double deepest() const { return largest(deepest_); }

 private:
  template <class Visit>
  void visit_segments(const SegmentPairs& pairs, Visit& visit) {
    if (parts_.begin() == parts_.end()) return;
    visit.begin(pairs, {pairs.along.at0 * pairs.inverse_length, pairs.along.at1 * pairs.inverse_length});
    for (const PackedParts::Eight& part : parts_) {
      const Lanes span_length = select(part.hit, part.span.high - part.span.low, Lanes{}),
                  weight = 0.25 * span_length * pairs.segments.length;
      deepest_ = max(deepest_,
                     select(part.hit, -min(pairs.height.at(part.span.low), pairs.height.at(part.span.high)), Lanes{}));
      constexpr double gauss = 0.21132486540518713;  // 1/2 - 1/sqrt(12)
      for (const double share : {gauss, 1 - gauss}) {
        const Lanes s = part.span.low + share * span_length;
        visit.on_segment(SegmentPoint{part.hit, s, pairs.height.at(s), weight});
      }
    }
    visit.end();
  }

  template <class Visit>
  void visit_fans(const SegmentPairs& pairs, const NodeLanes& nodes, Lanes xi, Visit& visit) {
    if (parts_.begin() == parts_.end()) return;
    visit.begin(pairs, {xi, xi});
    const SlaveSegments& slaves = pairs.segments;
    const Lanes x0 = slaves.x0 - nodes.x, y0 = slaves.y0 - nodes.y, dx = slaves.x1 - slaves.x0,
                dy = slaves.y1 - slaves.y0, side = select(nodes.convex, broadcast(1), broadcast(-1));
    const auto distance = [&](Lanes s) {
      const Lanes x = x0 + s * dx, y = y0 + s * dy;
      return sqrt(x * x + y * y);
    };
    const Lanes whole = sqrt(dx * dx + dy * dy);
    for (const PackedParts::Eight& part : parts_) {
      const Lanes span_length = select(part.hit, part.span.high - part.span.low, Lanes{});
      // The error of three points is rho^-6 of a part. There rho + 1/rho is twice the sum of the distances of its ends
      // from the node, over its length (Trefethen 2008, doi 10.1137/060659831): 1e-8 at 21.6.
      const LaneBits wide =
          nodes.convex & (2.0 * (distance(part.span.low) + distance(part.span.high)) < 21.6 * span_length * whole);
      FanShape shape{part.hit & ~wide};
      const auto point = [&](double share, double of_length) {
        const Lanes s = part.span.low + share * span_length, x = x0 + s * dx, y = y0 + s * dy, square = x * x + y * y;
        const LaneBits apart = square > 0.0;
        const Lanes outward = side * select(apart, inverse_sqrt(select(apart, square, broadcast(1))), Lanes{});
        const Lanes weight = select(wide, Lanes{}, (0.5 * of_length) * span_length * slaves.length),
                    gap = square * outward, normal_x = x * outward, normal_y = y * outward;
        deepest_ = max(deepest_, select(part.hit, -gap, Lanes{}));
        const Lanes second = s * weight, first = weight - second;
        visit.in_fan(FanPoint{part.hit & ~wide,
                              s,
                              gap,
                              weight,
                              normal_x,
                              normal_y,
                              weight,
                              {first * normal_x, second * normal_x},
                              {first * normal_y, second * normal_y},
                              {weight, second}});
        if constexpr (WantsFans<Visit>) {
          shape.gap.add(weight * gap, s);
          Lanes of_power = weight;
          for (int power = 0; power < 3; ++power, of_power *= s)
            shape.weight[power] += of_power, shape.normal_x[power] += of_power * normal_x,
                shape.normal_y[power] += of_power * normal_y;
        }
      };
      constexpr double gauss = 0.1127016653792583;  // 1/2 - sqrt(3/20)
      point(gauss, 5.0 / 18), point(0.5, 8.0 / 18), point(1 - gauss, 5.0 / 18);
      if constexpr (WantsFans<Visit>) visit.in_fan_of(shape);
      const FanParts closed{part.hit & wide, part.span, part.low, part.high, x0, y0, dx, dy, slaves.length};
      if (any(closed.hit)) visit_fan_forces(closed, visit);
    }
    visit.end();
  }

  SlaveArc slaves_;
  SegmentCandidates candidates_;
  PackedParts parts_;
  std::vector<Span8> spans_;  ///< scratch
  Lanes deepest_{};
};

/// One per thread, so that its memory is allocated once.
inline SegmentQuadrature& thread_quadrature() {
  thread_local SegmentQuadrature quadrature;
  return quadrature;
}

}  // namespace pliant
