#pragma once

#include "contact/laws/traction.hpp"

namespace pliant {

/// p = -kn g down to the tensile cut-off -t, zero beyond; |tau| <= c + friction max(p, 0) (docs/method.md 4). At the
/// cut-off the force jumps between two branches of one potential: closing the gap returns the energy that opening took.
struct MohrCoulomb {
  static constexpr bool has_shear = true;
  static constexpr const char* name = "mohr-coulomb";
  double normal_stiffness = 0;  ///< kn, Pa/m
  double shear_stiffness = 0;   ///< kt, Pa/m
  double reach = 0;             ///< t / kn, m
  double friction = 0;
  double cohesion = 0;  ///< Pa

  std::array<double, 2> kinks() const { return {0, reach}; }
  Traction operator()(Lanes gap) const {
    const LaneBits touching = gap < reach;
    const Lanes pressure = select(touching, -normal_stiffness * gap, Lanes{});
    const Lanes limit = select(touching, cohesion + friction * max(pressure, Lanes{}), Lanes{});
    return {pressure, limit, select(touching, 0.5 * normal_stiffness * (gap * gap - reach * reach), Lanes{})};
  }
};

}  // namespace pliant
