#pragma once

#include <array>

#include "core/lanes.hpp"

namespace pliant {

/// What a contact law answers for a gap g (negative: penetration), eight nodes at once.
struct Traction {
  Lanes pressure;     ///< Pa, positive in compression
  Lanes shear_limit;  ///< Pa, the largest |tau| of contacts that slide; laws with bonds may bear more
  Lanes energy;       ///< J/m2, normal part, dpsi/dg = -pressure, zero out of reach
};

}  // namespace pliant
