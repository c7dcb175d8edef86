#pragma once

#include "contact/laws/traction.hpp"

namespace pliant {

/// A law without tension, with a normal dashpot while g < 0 (docs/method.md 4). All nodes of a pair in touch, of total
/// length L, share the dashpot 2 z sqrt(kn L m) of a reduced mass m by their lengths: c = root_damping / sqrt(L) a unit
/// length. So a flat face that lands at once bounces with the asked restitution, and any other contact keeps the
/// damping ratio z of its present stiffness.
template <class Law>
struct Damped : Law {
  static constexpr bool has_damping = true;
  double root_damping = 0;   ///< 2 z sqrt(kn m), Pa s m^-1/2
  double damping_ratio = 0;  ///< z
  bool pull = false;         ///< the sum of spring and dashpot may pull until g = 0

  /// Pressure of the dashpot, Pa, where the elastic pressure acts too. `rate`: of the gap, m/s; damping: c, Pa s/m.
  Lanes damping_pressure(Lanes elastic_pressure, Lanes rate, double damping) const {
    const Lanes pressure = -damping * rate;
    return pull ? pressure : max(pressure, -elastic_pressure);
  }
};

}  // namespace pliant
