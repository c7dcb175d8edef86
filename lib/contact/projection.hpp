#pragma once

#include <algorithm>
#include <vector>

#include "bodies/outline.hpp"
#include "contact/patch.hpp"
#include "core/lanes.hpp"

namespace pliant {

/// The master's arc with what its segments need, rebuilt at every evaluation. Local node w is outline node arc.begin - 2 + w; candidate
/// segments run from local node 1 to arc.count + 1, one more than the arc at either end.
struct MasterWindow {
  int nodes = 0;       ///< arc.count + 4
  double longest = 0;  ///< candidate segment, m
  std::vector<double> x, y, tangent_x, tangent_y, length, bisector_x, bisector_y, reference_length, arc;

  int first_segment() const { return 1; }
  int end_segment() const { return nodes - 2; }
  void fill(const OutlineShape& shape, const double* outline_x, const double* outline_y, const Arc& range,
            double shift);
};

/// Stage 3 of METHOD 4 for eight slave nodes: the segment whose wedge, between the two angle bisectors, holds the node.
struct Projection {
  LaneBits hit;
  Lanes segment;  ///< local index of the segment's first node
  Lanes rx, ry;   ///< node position from the segment's first node, m
  Lanes height;   ///< distance from the segment's line, outward positive, m
  Lanes tangent_x, tangent_y;
  Lanes length, reference_length, arc;  ///< of the segment; arc: reference arc coordinate of its first node, m
};

/// Depth of the contact box below a segment, over its length. A node inside a body is always a contact, so the depth only has to keep
/// nodes from being pushed out on the far side of a thin body; METHOD's 1/2 was used up by force chains of rigid grains.
inline constexpr double inward_depth = 1.0;

/// Searches all candidate segments of a window. A node counts when it lies between inward_depth lengths inward and `outward` outward;
/// of several segments (sharp or thin masters) the nearest line wins, the first of equals.
inline Projection project(const MasterWindow& window, Lanes px, Lanes py, double outward) {
  Projection best{};
  Lanes best_distance = broadcast(1e300);
  const int first = window.first_segment();
  // The near side of a thin or pointed body must compete wherever the far side does: else nodes outside would be caught from behind.
  const double highest = std::max(outward, inward_depth * window.longest);
  Lanes rx = px - window.x[first], ry = py - window.y[first];
  // Neighbours share the bisector's value, so that every node beside the arc falls to exactly one of them.
  Lanes before = rx * window.bisector_x[first] + ry * window.bisector_y[first];
  for (int s = first; s < window.end_segment(); ++s) {
    const Lanes next_rx = px - window.x[s + 1], next_ry = py - window.y[s + 1];
    const Lanes after = next_rx * window.bisector_x[s + 1] + next_ry * window.bisector_y[s + 1];
    const Lanes height = rx * window.tangent_y[s] - ry * window.tangent_x[s];
    const Lanes distance = abs(height);
    const LaneBits inside = (before >= 0.0) & (after < 0.0) & (height <= highest) &
                            (height >= -inward_depth * window.length[s]) & (distance < best_distance);
    if (any(inside)) {
      best_distance = select(inside, distance, best_distance);
      best.segment = select(inside, broadcast(s), best.segment);
      best.rx = select(inside, rx, best.rx);
      best.ry = select(inside, ry, best.ry);
      best.height = select(inside, height, best.height);
      best.tangent_x = select(inside, broadcast(window.tangent_x[s]), best.tangent_x);
      best.tangent_y = select(inside, broadcast(window.tangent_y[s]), best.tangent_y);
      best.length = select(inside, broadcast(window.length[s]), best.length);
      best.reference_length = select(inside, broadcast(window.reference_length[s]), best.reference_length);
      best.arc = select(inside, broadcast(window.arc[s]), best.arc);
    }
    rx = next_rx, ry = next_ry, before = after;
  }
  best.hit = (best_distance < 1e300) & (best.height <= outward);
  return best;
}

/// Where a projected node stands: gap and normal, orthogonal to the segment or, beyond an end, radial from that end node.
struct ContactPoint {
  Lanes gap;  ///< m, negative inside
  Lanes normal_x, normal_y;
  Lanes xi;  ///< [0, 1] along the segment
};

inline ContactPoint locate(const Projection& p) {
  const Lanes along = p.rx * p.tangent_x + p.ry * p.tangent_y;
  const Lanes safe_length = select(p.hit, p.length, broadcast(1));
  const Lanes xi = min(max(along / safe_length, Lanes{}), broadcast(1));
  ContactPoint point{p.height, p.tangent_y, -p.tangent_x, xi};
  const LaneBits beyond = p.hit & ((along < 0.0) | (along > p.length));
  if (any(beyond)) {
    const Lanes ex = p.rx - xi * p.length * p.tangent_x, ey = p.ry - xi * p.length * p.tangent_y;
    const Lanes distance = sqrt(ex * ex + ey * ey);
    const LaneBits radial = beyond & (distance > 0.0);
    const Lanes gap = select(p.height < 0.0, -distance, distance);
    const Lanes safe_gap = select(radial, gap, broadcast(1));
    point.gap = select(radial, gap, point.gap);
    point.normal_x = select(radial, ex / safe_gap, point.normal_x);
    point.normal_y = select(radial, ey / safe_gap, point.normal_y);
  }
  return point;
}

}  // namespace pliant
