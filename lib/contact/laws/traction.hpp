#pragma once

#include <array>

#include "core/lanes.hpp"

namespace pliant {

/// Response of a contact law to a gap g (negative: penetration), for eight nodes at once.
struct Traction {
  Lanes pressure;     ///< Pa, positive in compression
  Lanes shear_limit;  ///< Pa, the largest |tau| of sliding contacts; laws with bonds may exceed it
  Lanes energy;       ///< J/m2, normal part, dpsi/dg = -pressure, zero out of reach
};

}  // namespace pliant
