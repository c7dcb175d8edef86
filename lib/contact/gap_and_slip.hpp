#pragma once

#include "contact/laws/response.hpp"
#include "contact/slip.hpp"

namespace pliant {

/// Eight nodes, by where they were on the master at the last accepted step, and are now: place_of(p).
template <class Law>
GapAndSlip gap_and_slip(const Law&, const MasterWindow& window, const Projection& p, LaneBits touching, Lanes old_place,
                        Lanes place) {
  GapAndSlip at{p.gap, p.hit, touching, {}};
  if constexpr (Law::has_shear) {
    const LaneBits known = old_place == old_place;
    at.moved = moved_along(window, p, touching & known, select(known, old_place, place), place);
  }
  return at;
}

}  // namespace pliant
