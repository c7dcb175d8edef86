#pragma once

#include "contact/laws/traction.hpp"

namespace pliant {

/// p = kn max(-g, 0), no shear (docs/method.md 4).
struct Frictionless {
  static constexpr bool has_shear = false;
  static constexpr const char* name = "frictionless";
  double normal_stiffness = 0;  ///< kn, Pa/m
  double shear_stiffness = 0;   ///< unused
  double reach = 0;             ///< largest gap with a traction, m

  /// Gaps at which tractions are not smooth, ascending, m; the last one is the reach.
  std::array<double, 1> kinks() const { return {0}; }
  Traction operator()(Lanes gap) const {
    const Lanes pressure = max(-normal_stiffness * gap, Lanes{});
    return {pressure, Lanes{}, 0.5 * pressure * pressure / normal_stiffness};
  }
};

}  // namespace pliant
