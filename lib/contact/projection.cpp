#include "contact/projection.hpp"

namespace pliant {

Lanes find_nearest_segments(const MasterWindow& window, Lanes px, Lanes py, double reach) {
  Lanes nearest = broadcast(reach * reach), steepest{}, found = broadcast(-1);
  const int last = window.count() - 1;
  for (int row = 0; row <= last; ++row) {
    const MasterSegment &segment = window[row], &next = window[row + 1];
    const Lanes rx = px - segment.x, ry = py - segment.y, qx = px - next.x, qy = py - next.y;
    const Lanes along = rx * segment.tangent_x + ry * segment.tangent_y,
                height = rx * segment.tangent_y - ry * segment.tangent_x;
    const Lanes square = height * height;
    // By the end nodes' own coordinates, so that the two segments at a node are exactly as near.
    const Lanes distance =
        select(along < 0.0, rx * rx + ry * ry, select(along > segment.length, qx * qx + qy * qy, square));
    LaneBits nearer = (distance < nearest) | ((distance == nearest) & (square > steepest));
    if (row == 0) nearer = nearer & (rx * segment.bisector_x + ry * segment.bisector_y >= 0.0);
    if (row == last) nearer = nearer & (qx * next.bisector_x + qy * next.bisector_y < 0.0);
    nearest = select(nearer, distance, nearest);
    steepest = select(nearer, square, steepest);
    found = select(nearer, broadcast(row), found);
  }
  return found;
}

}  // namespace pliant
