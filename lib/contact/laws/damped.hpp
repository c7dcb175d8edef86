#pragma once

#include "contact/laws/traction.hpp"

namespace pliant {

/// A law without tension, with a normal dashpot while g < 0 (docs/method.md 4). All that touches of a pair, of total
/// length L, shares the dashpot 2 z sqrt(kn L m) of a reduced mass m: c = root_damping / sqrt(L) a unit
/// length. So a flat face that lands at once bounces with the asked restitution, and any other contact keeps the
/// damping ratio z of its present stiffness.
template <class Law>
struct Damped : Law {
  static constexpr bool has_damping = true;
  double root_damping = 0;   ///< 2 z sqrt(kn m), Pa s m^-1/2
  double damping_ratio = 0;  ///< z
  bool pull = false;         ///< the sum of spring and dashpot may pull until g = 0

  /// Pressure of the dashpot, Pa, where the elastic pressure acts too. `rate`: of the gap, m/s; damping: c, Pa s/m;
  /// `step`: that led here, s.
  Lanes damping_pressure(Lanes elastic_pressure, Lanes gap, Lanes rate, double damping, double step) const {
    const Lanes pressure = -damping * rate * share(gap, rate, step);
    return pull ? pressure : max(pressure, -elastic_pressure);
  }

 private:
  /// The pressure is there at once when a node touches, and gone at once when it may pull until the gap opens. In the
  /// step with that a node is in touch for a share s, not for half of it, which is what the mean of the pressures at
  /// its ends makes of it: so the one in touch should count s + 1/2. Instead it counts 3/2 s and the one a step
  /// deeper 3/2 - s/2: together as much, s + 1/2 and 1, but without a jump where s is 0 or 1, which rates that change
  /// would make a matter of chance.
  Lanes share(Lanes gap, Lanes rate, double step) const {
    const Lanes speed = pull ? abs(rate) : -rate, way = speed * step;
    const LaneBits arrives = (gap < 0.0) & (-gap < 2 * way);
    // Elsewhere the way may be 0.
    const Lanes steps = select(arrives, -gap / select(arrives, way, broadcast(1)), broadcast(2));
    return min(1.5 * steps, 2 - 0.5 * steps);
  }
};

}  // namespace pliant
