#pragma once

#include <algorithm>

#include "contact/master_window.hpp"
#include "core/lanes.hpp"

namespace pliant {

/// Stage 3 of docs/method.md 4 for eight slave nodes: the segment whose wedge, between the two angle bisectors, holds
/// the node, and where the node
/// stands beside it: orthogonal or, beyond an end, radial from that end node.
struct Projection {
  LaneBits hit;
  Lanes row;     ///< of the window
  Lanes number;  ///< of the segment in its outline
  Lanes length, inverse_length;
  Lanes tangent_x, tangent_y;
  Lanes height;  ///< distance from the segment's line, outward positive, m
  Lanes gap;     ///< m, negative inside
  Lanes normal_x, normal_y;
  Lanes xi;   ///< [0, 1] along the segment
  Lanes fan;  ///< beyond an end: sine of the turn from the segment's normal to the node's; 0 beside the segment
};

/// Row of the nearest segment's line among those whose wedges hold the nodes, at most `reach` off; -1: none. Of equals
/// the first.
inline Lanes find_segments(const MasterWindow& window, Lanes px, Lanes py, double reach) {
  Lanes nearest = broadcast(reach), found = broadcast(-1);
  const MasterSegment* segment = &window[0];
  Lanes rx = px - segment->x, ry = py - segment->y;
  // Neighbours share the bisector's value, so that every node beside the arc falls to exactly one of them.
  Lanes before = rx * segment->bisector_x + ry * segment->bisector_y;
  for (int row = 0; row < window.count(); ++row, ++segment) {
    const Lanes distance = abs(rx * segment->tangent_y - ry * segment->tangent_x);
    rx = px - segment[1].x, ry = py - segment[1].y;
    const Lanes after = rx * segment[1].bisector_x + ry * segment[1].bisector_y;
    const LaneBits nearer = (before >= 0.0) & (after < 0.0) & (distance < nearest);
    nearest = select(nearer, distance, nearest);
    found = select(nearer, broadcast(row), found);
    before = after;
  }
  return found;
}

/// Where nodes stand beside the segments of the rows given, at most `outward` off.
inline Projection beside(const MasterWindow& window, Lanes px, Lanes py, Lanes row_of_node, double outward) {
  Projection p;
  p.row = row_of_node;
  p.hit = p.row >= 0.0;
  p.fan = Lanes{};  // read even where nothing is hit
  if (!any(p.hit)) return p;
  Lanes rows[8], columns[8];
  for (int lane = 0; lane < lane_count; ++lane)
    rows[lane] = load(&window[std::max(0, static_cast<int>(p.row[lane]))].x);
  transpose(rows, columns);
  const Lanes rx = px - columns[0], ry = py - columns[1];
  p.tangent_x = columns[2], p.tangent_y = columns[3];
  p.length = columns[4], p.inverse_length = columns[5];
  p.number = window.numbers(max(p.row, Lanes{}));
  p.height = rx * p.tangent_y - ry * p.tangent_x;
  p.hit = p.hit & (p.height <= outward);
  const Lanes along = rx * p.tangent_x + ry * p.tangent_y;
  p.xi = min(max(along * p.inverse_length, Lanes{}), broadcast(1));
  p.gap = p.height;
  p.normal_x = p.tangent_y, p.normal_y = -p.tangent_x;
  if (const LaneBits beyond = p.hit & ((along < 0.0) | (along > p.length)); any(beyond)) {
    const Lanes over = along - p.xi * p.length;
    const Lanes distance = sqrt(over * over + p.height * p.height);
    const LaneBits radial = beyond & (distance > 0.0);
    const Lanes gap = select(radial, select(p.height < 0.0, -distance, distance), broadcast(1));
    p.gap = select(radial, gap, p.gap);
    p.fan = select(radial, over / gap, p.fan);
    const Lanes cosine = select(radial, p.height / gap, broadcast(1));
    p.normal_x = cosine * p.tangent_y + p.fan * p.tangent_x;
    p.normal_y = p.fan * p.tangent_y - cosine * p.tangent_x;
  }
  return p;
}

/// Projects nodes for which wedges mislead once more, each to its truly nearest segment, at most `reach` off.
void project_to_nearest(const MasterWindow& window, Lanes px, Lanes py, LaneBits misled, double reach, double outward,
                        Projection& projection);

/// Nodes count from the window's depth inward to `outward` outward. The near side of a thin or pointed body competes as
/// far as its far side does: else nodes outside would be caught from behind.
inline Projection project(const MasterWindow& window, Lanes px, Lanes py, double outward) {
  const double reach = std::max(outward, window.depth());
  Projection p = beside(window, px, py, find_segments(window, px, py, reach), outward);
  // Up to here a node is at most 1 % nearer to the line than to the segment.
  constexpr double steep = 0.14;
  if (const LaneBits misled = p.hit & (abs(p.fan) > steep); any(misled)) [[unlikely]]
    project_to_nearest(window, px, py, misled, reach, outward, p);
  return p;
}

}  // namespace pliant
