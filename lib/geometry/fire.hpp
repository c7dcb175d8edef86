#pragma once

#include <algorithm>

namespace pliant {

/// Time step of the fast inertial relaxation engine (Bitzek and others 2006, Phys. Rev. Lett. 97, 170201) and the share
/// by which it rotates velocities towards forces; the constants are those of its authors. In the units of time a node's
/// contact has a stiffness of some 0.1, and a grain one of 1 in all, at mass 1.
struct Fire {
  static constexpr double first_step = 0.3, longest_step = 1.5;
  static constexpr int patience = 5;
  static constexpr double growth = 1.1, cut = 0.5, first_alpha = 0.1, fade = 0.99;
  double dt = first_step, alpha = first_alpha;
  int downhill = 0;

  void adapt(bool down) {
    if (!down) {
      dt *= cut, alpha = first_alpha, downhill = 0;
    } else if (++downhill > patience) {
      dt = std::min(dt * growth, longest_step), alpha *= fade;
    }
  }
};

}  // namespace pliant
