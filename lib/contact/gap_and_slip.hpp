#pragma once

#include "contact/laws/response.hpp"
#include "contact/slip.hpp"

namespace pliant {

/// Gap and slip increment of eight nodes, from their surface coordinates place_of(p) on the master at the last accepted
/// step and now.
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
