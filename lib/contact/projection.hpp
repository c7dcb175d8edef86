#pragma once

#include <algorithm>

#include "contact/master_window.hpp"
#include "core/lanes.hpp"

namespace pliant {

/// Stage 3 of docs/method.md 4 for eight slave nodes: the segment whose Voronoi region, between the two angle
/// bisectors, contains the node, and the node's projection onto it: orthogonal or, beyond an end, radial from that end
/// node.
struct Projection {
  LaneBits hit;
  Lanes row;     ///< row of the window
  Lanes number;  ///< of the segment in its outline
  Lanes length, inverse_length;
  Lanes tangent_x, tangent_y;
  Lanes height;  ///< distance from the segment's line, positive outside, m
  Lanes gap;     ///< m, negative inside
  Lanes normal_x, normal_y;
  Lanes xi;           ///< [0, 1] along the segment
  Lanes sine_beyond;  ///< beyond an end: sine of the angle from the segment's normal to the node's; 0 on the segment
};

/// Row of the segment whose line is nearest, among those whose Voronoi regions contain the nodes, at most `reach` away;
/// -1: none. The first of equally near ones counts.
Lanes find_nearest_wedges(const MasterWindow& window, Lanes px, Lanes py, double reach);

/// Rows of the segments whose Voronoi regions contain the nodes; -1: none.
struct Wedges {
  Lanes row;
  LaneBits in_order;  ///< bisector tests are monotone, so no other region contains the node
};

inline Wedges find_wedges(const MasterWindow& window, Lanes px, Lanes py) {
  const double *bisector_x = window.column(MasterWindow::bisector_x),
               *bisector_y = window.column(MasterWindow::bisector_y),
               *bisector_at = window.column(MasterWindow::bisector_at);
  const Lanes rx = px - window.origin_x(), ry = py - window.origin_y();
  // Neighbours share the bisector's value, so each node that projects on the arc belongs to exactly one of them.
  const auto is_beyond = [&](int k) { return rx * bisector_x[k] + (ry * bisector_y[k] - bisector_at[k]) >= 0.0; };
  Lanes count{};
  LaneBits in_order = ~LaneBits{};
  // One bit per bisector, in groups that fit a number. Tests are monotone if there is no gap between ones, and if a
  // group has ones only when all groups before it are full.
  constexpr int most = 32;
  for (int first = 0; first <= window.count(); first += most) {
    const int size = std::min(most, window.count() + 1 - first);
    LaneBits passed{}, bit = LaneBits{} + 1;
    for (int k = 0; k < size; ++k, bit += bit) passed |= is_beyond(first + k) & bit;
    in_order &= ((passed & (passed + 1)) == 0) & ((passed == 0) | (count == first));
    count += exponent_of(passed + 1);
  }
  return {select(count <= window.count(), count - 1.0, broadcast(-1)), in_order};
}

/// Projections of nodes onto the segments of the given rows, at most `outward` away.
inline Projection project_on_row(const MasterWindow& window, Lanes px, Lanes py, Lanes row_of_node, double outward) {
  Projection p;
  p.row = row_of_node;
  p.hit = p.row >= 0.0;
  p.sine_beyond = Lanes{};  // read even without a projection
  if (!any(p.hit)) return p;
  const Lanes some_row = max(p.row, Lanes{});
  const LaneBits rows = __builtin_convertvector(some_row, LaneBits);
  const Lanes rx = px - window.entries(MasterWindow::x, rows), ry = py - window.entries(MasterWindow::y, rows);
  p.tangent_x = window.entries(MasterWindow::tangent_x, rows);
  p.tangent_y = window.entries(MasterWindow::tangent_y, rows);
  p.length = window.entries(MasterWindow::length, rows);
  p.inverse_length = window.entries(MasterWindow::inverse_length, rows);
  p.number = window.numbers(some_row);
  p.height = rx * p.tangent_y - ry * p.tangent_x;
  p.hit = p.hit & (p.height <= outward);
  const Lanes along = rx * p.tangent_x + ry * p.tangent_y;
  const Lanes xi = along * p.inverse_length;
  p.xi = min(max(xi, Lanes{}), broadcast(1));
  p.gap = p.height;
  p.normal_x = p.tangent_y, p.normal_y = -p.tangent_x;
  if (const LaneBits beyond = p.hit & ((xi < -ties_up_to) | (xi > 1 + ties_up_to)); any(beyond)) {
    const Lanes over = along - p.xi * p.length;
    const Lanes distance = sqrt(over * over + p.height * p.height);
    const LaneBits radial = beyond & (distance > 0.0);
    const Lanes gap = select(radial, select(p.height < 0.0, -distance, distance), broadcast(1));
    p.gap = select(radial, gap, p.gap);
    p.sine_beyond = select(radial, over / gap, p.sine_beyond);
    const Lanes cosine = select(radial, p.height / gap, broadcast(1));
    p.normal_x = cosine * p.tangent_y + p.sine_beyond * p.tangent_x;
    p.normal_y = p.sine_beyond * p.tangent_y - cosine * p.tangent_x;
  }
  return p;
}

/// Projects the nodes for which Voronoi regions mislead again, each onto its truly nearest segment, at most `reach`
/// away.
void project_to_nearest(const MasterWindow& window, Lanes px, Lanes py, LaneBits misled, double reach, double outward,
                        Projection& projection);

/// Projects nodes from the window's depth inside to `outward` outside. The near side of a thin or pointed body competes
/// as far as its far side does; else nodes outside would project onto the far side from behind.
inline Projection project(const MasterWindow& window, Lanes px, Lanes py, double outward) {
  const double reach = std::max(outward, window.depth());
  const Wedges wedges = find_wedges(window, px, py);
  const Lanes rows = any(~wedges.in_order) ? find_nearest_wedges(window, px, py, reach) : wedges.row;
  Projection p = project_on_row(window, px, py, rows, outward);
  p.hit = p.hit & (abs(p.height) < reach);
  // Up to this sine a node is at most 1 % nearer to the line than to the segment.
  constexpr double steep = 0.14;
  if (const LaneBits misled = p.hit & (abs(p.sine_beyond) > steep); any(misled)) [[unlikely]]
    project_to_nearest(window, px, py, misled, reach, outward, p);
  return p;
}

}  // namespace pliant
