#pragma once

#include "contact/laws/response.hpp"
#include "contact/projection.hpp"

namespace pliant {

/// Surface coordinate of a node on the master's outline as one number, for the history: twice the segment's number,
/// plus xi on the segment. Beyond an end it is outside [0, 1]: by |sine_beyond|/4 outside the outline, by 0.3 + 0.15
/// |sine_beyond| inside a re-entrant corner, where the normal turns against the direction of motion. The offset is
/// always less than 1/2, so that every coordinate belongs to one segment.
inline Lanes place_of(const Projection& p) {
  const Lanes turn = abs(p.sine_beyond);
  const Lanes off = select(p.gap < 0.0, 0.3 + 0.15 * turn, 0.25 * turn);
  const Lanes onward = select(p.xi > 0.5, off, -off);
  return 2.0 * p.number + p.xi + select(p.sine_beyond != 0.0, onward, Lanes{});
}

/// The fan of a surface coordinate that is `off` outside [0, 1].
inline Lanes fan_of(Lanes off) {
  const Lanes size = abs(off), inside = (size - 0.3) * (1 / 0.15);
  return select(size > 0.275, select(off > 0.0, -inside, inside), 4.0 * off);
}

/// Path length along the outline, signed, m, from an old surface coordinate on another segment to the projection in one
/// lane, at its present gap and shape. Faces count by their length, corners by the rotation of the normal. Between
/// flanks of a fold the displacement along them counts instead.
double distance_between_segments(const MasterWindow& window, const Projection& p, int lane, double old_place);

/// Slip increment of eight nodes along the master since the last accepted step, m. It is a rate in the present shape
/// (on a segment l d(xi), beyond an end g d(angle)), so that the shear force is its exact conjugate. `place`:
/// place_of(p), rounded like the old one, so that a node at rest gives exactly 0. `counted`: lanes in contact whose old
/// place is known; others give 0.
inline Lanes moved_along(const MasterWindow& window, const Projection& p, LaneBits counted, Lanes old_place,
                         Lanes place) {
  const Lanes u = place - 2.0 * p.number, old_u = old_place - 2.0 * p.number;
  const Lanes xi = min(max(u, Lanes{}), broadcast(1)), old_xi = min(max(old_u, Lanes{}), broadcast(1));
  Lanes moved = p.length * (xi - old_xi);
  const LaneBits same = abs(old_u - 0.5) < 1.0;
  if (any(counted & same & ((u != xi) | (old_u != old_xi)))) {
    const Lanes fan = fan_of(u - xi), old_fan = fan_of(old_u - old_xi);
    const Lanes cosine = sqrt(max(1.0 - fan * fan, Lanes{})), old_cosine = sqrt(max(1.0 - old_fan * old_fan, Lanes{}));
    moved += p.gap * (fan * old_cosine - cosine * old_fan);
  }
  if (const LaneBits crossed = counted & ~same; any(crossed))
    for (int lane = 0; lane < lane_count; ++lane)
      if (crossed[lane]) moved[lane] = distance_between_segments(window, p, lane, old_place[lane]);
  return select(counted, moved, Lanes{});
}

/// Slip increment of eight nodes, m, from their surface coordinates place_of(p) on the master at the last accepted step
/// and now. 0 for laws without shear.
template <class Law>
Lanes slip_increment(const Law&, const MasterWindow& window, const Projection& p, LaneBits touching, Lanes old_place,
                     Lanes place) {
  if constexpr (!Law::has_shear) return Lanes{};
  const LaneBits known = old_place == old_place;
  return moved_along(window, p, touching & known, select(known, old_place, place), place);
}

}  // namespace pliant
