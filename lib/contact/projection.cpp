#include "contact/projection.hpp"

namespace pliant {
namespace {

/// Tolerance for distances to an end node that two segments share. They differ by rounding, as the compiler may
/// contract them in two ways.
constexpr double same_distance = 1e-12;

/// Row of the nearest segment, at most `reach` away; -1: none. Voronoi regions do not count: they mislead where a face
/// ends before the bisector between it and its neighbour does. Of the two segments at an end node the one seen more
/// steeply counts, as it tells inside from outside. Beyond the ends of the window nothing is near.
Lanes find_nearest_segments(const MasterWindow& window, Lanes px, Lanes py, double reach) {
  Lanes nearest = broadcast(reach * reach), steepest{}, found = broadcast(-1);
  const int last = window.count() - 1;
  for (int row = 0; row <= last; ++row) {
    const MasterSegment segment = window[row], next = window[row + 1];
    const Lanes rx = px - segment.x, ry = py - segment.y, qx = px - next.x, qy = py - next.y;
    const Lanes along = rx * segment.tangent_x + ry * segment.tangent_y,
                height = rx * segment.tangent_y - ry * segment.tangent_x;
    const Lanes square = height * height;
    const Lanes distance =
        select(along < 0.0, rx * rx + ry * ry, select(along > segment.length, qx * qx + qy * qy, square));
    LaneBits nearer = (distance < (1 - same_distance) * nearest) |
                      ((distance <= (1 + same_distance) * nearest) & (found >= 0.0) & (square > steepest));
    if (row == 0) nearer = nearer & (rx * segment.bisector_x + ry * segment.bisector_y >= 0.0);
    if (row == last) nearer = nearer & (qx * next.bisector_x + qy * next.bisector_y < 0.0);
    nearest = select(nearer, distance, nearest);
    steepest = select(nearer, square, steepest);
    found = select(nearer, broadcast(row), found);
  }
  return found;
}

}  // namespace

Lanes find_nearest_wedges(const MasterWindow& window, Lanes px, Lanes py, double reach) {
  const Lanes rx = px - window.origin_x(), ry = py - window.origin_y();
  const auto beyond = [&](int row) {
    return rx * window.column(MasterWindow::bisector_x)[row] +
           (ry * window.column(MasterWindow::bisector_y)[row] - window.column(MasterWindow::bisector_at)[row]);
  };
  Lanes nearest = broadcast(reach), found = broadcast(-1), before = beyond(0);
  for (int row = 0; row < window.count(); ++row) {
    const MasterSegment segment = window[row];
    const Lanes distance = abs((px - segment.x) * segment.tangent_y - (py - segment.y) * segment.tangent_x);
    const Lanes after = beyond(row + 1);
    const LaneBits nearer = (before >= 0.0) & (after < 0.0) & (distance < nearest);
    nearest = select(nearer, distance, nearest);
    found = select(nearer, broadcast(row), found);
    before = after;
  }
  return found;
}

void project_to_nearest(const MasterWindow& window, Lanes px, Lanes py, LaneBits misled, double reach, double outward,
                        Projection& projection) {
  const Lanes row = select(misled, find_nearest_segments(window, px, py, reach), projection.row);
  projection = project_on_row(window, px, py, row, outward);
}

}  // namespace pliant
