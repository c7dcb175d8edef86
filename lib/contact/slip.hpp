#pragma once

#include "contact/half_pass.hpp"
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

/// Former surface coordinates of eight slave nodes, and what else is needed of their former positions.
struct FormerPlaces {
  Lanes place;           ///< NaN: unknown
  const PairView& view;  ///< view.before: outlines then; null: heights and gaps are the present ones
  const HalfPass& pass;
  int first;  ///< position of the first node in the pass
};

/// Path length along the outline, signed, m, from a former surface coordinate to the present one, `place`, of the
/// projection in one lane. Faces count by their length, corners and vertex regions by the rotation of the normal:
/// lengths, gaps, heights and turns of corners are means of both ends of the step. Between flanks of a fold the
/// displacement along them counts instead.
double distance_along(const MasterWindow& window, const Projection& p, int lane, const FormerPlaces& from,
                      double place);

/// Slip increment of eight nodes along the master since the last accepted step, m. It is the integral of a rate, on a
/// segment l d(xi), beyond an end g d(angle), of which the shear force is the exact conjugate. Lengths and gaps are
/// the means of both ends of the step: with those of its end, shears in outlines that vibrate would create energy of
/// first order in the step. `place`: place_of(p), rounded like the former one, so that a node at rest gives exactly 0.
/// `counted`: lanes in contact whose former place is known; others give 0.
inline Lanes moved_along(const MasterWindow& window, const Projection& p, LaneBits counted, const FormerPlaces& from,
                         Lanes place) {
  const Lanes u = place - 2.0 * p.number, old_u = from.place - 2.0 * p.number;
  const Lanes mean_length =
      window.entries(MasterWindow::mean_length, __builtin_convertvector(max(p.row, Lanes{}), LaneBits));
  const auto on_segment = [](Lanes at) { return (at >= 0.0) & (at <= 1.0); };
  Lanes moved = mean_length * (u - old_u);
  for_each_lane(counted & ~(on_segment(u) & on_segment(old_u)),
                [&](int lane) { moved[lane] = distance_along(window, p, lane, from, place[lane]); });
  return select(counted, moved, Lanes{});
}

/// Slip increment of eight nodes, m, from their surface coordinates place_of(p) on the master at the last accepted step
/// and now. 0 for laws without shear.
template <class Law>
Lanes slip_increment(const Law&, const MasterWindow& window, const Projection& p, LaneBits touching,
                     const FormerPlaces& from, Lanes place) {
  if constexpr (!Law::has_shear) return Lanes{};
  const LaneBits known = from.place == from.place;
  const FormerPlaces numbers{select(known, from.place, place), from.view, from.pass, from.first};
  return moved_along(window, p, touching & known, numbers, place);
}

}  // namespace pliant
