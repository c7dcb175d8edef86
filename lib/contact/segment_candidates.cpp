#include "contact/segment_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/segment_cuts.hpp"

namespace pliant {
namespace {

/// Bounds of a function along each of eight slave segments.
struct Bounds8 {
  Lanes low, high;
};

/// Bounds of c_x x + c_y y + c.
Bounds8 bounds(double c_x, double c_y, double c, Lanes x0, Lanes y0, Lanes x1, Lanes y1) {
  const Lanes at0 = x0 * c_x + (y0 * c_y + c), at1 = x1 * c_x + (y1 * c_y + c);
  return {min(at0, at1), max(at0, at1)};
}

/// Largest distance from a node at which its vertex region counts; 0: the node has none.
double fan_radius(const MasterSegment& after, const GapRanges& ranges) {
  const double turn = after.bisector_x * after.tangent_y - after.bisector_y * after.tangent_x;
  if (std::abs(turn) < least_turn) return 0;
  return turn > 0 ? ranges.reach : ranges.deepest();
}

}  // namespace

void SegmentCandidates::find(const SlaveArc& slaves, const MasterWindow& window, const Arc& rows,
                             const GapRanges& ranges) {
  segments.clear(), fans.clear();
  if (rows.count == 0) return;
  const double *x = slaves.x.data(), *y = slaves.y.data();
  const MasterSegment start = window[rows.begin], end = window[rows.end()];
  const double farthest =
      std::max(ranges.deepest(), ranges.reach);  // below a segment's line, also for a vertex region outside
  const bool whole = start.x == end.x && start.y == end.y;
  past_end_.assign(static_cast<std::size_t>(padded(slaves.segments) / lane_count), ~LaneBits{});
  for (int row = rows.begin; row <= rows.end(); ++row) {
    const MasterSegment m = window[row];
    const double tx = m.tangent_x, ty = m.tangent_y, margin = 1e-9 * m.length;  // far more than rounding
    // On a whole outline the first node has the vertex region of the last.
    const double radius = row == rows.end() && whole ? 0 : fan_radius(m, ranges);
    for (int i = 0; i < slaves.segments; i += lane_count) {
      LaneBits& past_end = past_end_[static_cast<std::size_t>(i / lane_count)];
      const LaneBits past_last = std::exchange(past_end, LaneBits{});
      const Lanes x0 = load(x + i), y0 = load(y + i), x1 = load(x + i + 1), y1 = load(y + i + 1);
      const Bounds8 height = bounds(ty, -tx, m.y * tx - m.x * ty, x0, y0, x1, y1);
      const LaneBits near = first_lanes(slaves.segments - i) & (height.low < ranges.reach) & (height.high > -farthest);
      if (!any(near)) continue;
      const Bounds8 along = bounds(tx, ty, -m.x * tx - m.y * ty, x0, y0, x1, y1);
      if (radius > 0) {
        const LaneBits in_box =
            (along.low < margin) & (along.high > -radius) & (height.low < radius) & (height.high > -radius);
        if (const unsigned found = bits(past_last & near & in_box)) fans.add(found, i, row);
      }
      if (row == rows.end()) continue;
      const LaneBits within = (along.high > -margin) & (along.low < m.length + margin);
      if (const unsigned found = bits(within & near)) segments.add(found, i, row);
      past_end = near & (along.high > m.length - margin);
    }
  }
  segments.close(), fans.close();
}

}  // namespace pliant
