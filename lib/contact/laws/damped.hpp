#pragma once

#include "contact/laws/traction.hpp"

namespace pliant {

/// Law without tension, with a normal dashpot while g < 0 (docs/method.md 4). All contacts of a pair, of total length
/// L, share the dashpot 2 z sqrt(kn L m) of a reduced mass m: c = root_damping / sqrt(L) per unit length. Thus a flat
/// face that lands at once rebounds with the given restitution, and any other contact has the damping ratio z of its
/// present stiffness.
template <class Law>
struct Damped : Law {
  static constexpr bool has_damping = true;
  double root_damping = 0;   ///< 2 z sqrt(kn m), Pa s m^-1/2
  double damping_ratio = 0;  ///< z
  bool pull = false;         ///< spring and dashpot together may pull until g = 0

  /// Pressure of the dashpot, Pa, which adds to the elastic pressure. `rate`: of the gap, m/s; `damping`: c, Pa s/m;
  /// `step`: size of the step that led here, s.
  Lanes damping_pressure(Lanes elastic_pressure, Lanes gap, Lanes rate, double damping, double step) const {
    const Lanes pressure = -damping * rate * share(gap, rate, step);
    return pull ? pressure : max(pressure, -elastic_pressure);
  }

 private:
  /// The dashpot's pressure jumps when a node comes into contact, and when it opens if the dashpot may pull until then.
  /// In the step with the jump a node is in contact for a share s. The mean of the pressures at the step's ends makes
  /// half a step of it, so the node in contact should count s + 1/2. Instead it counts 3/2 s, and the node that is one
  /// step deeper counts 3/2 - s/2. Together they count as much, s + 1/2 and 1, but without a jump at s = 0 or 1. There
  /// rates that change would make the jump a matter of chance.
  Lanes share(Lanes gap, Lanes rate, double step) const {
    const Lanes speed = pull ? abs(rate) : -rate, way = speed * step;
    const LaneBits arrives = (gap < 0.0) & (-gap < 2 * way);
    // In other lanes the displacement may be 0.
    const Lanes steps = select(arrives, -gap / select(arrives, way, broadcast(1)), broadcast(2));
    return min(1.5 * steps, 2 - 0.5 * steps);
  }
};

}  // namespace pliant
