#include "contact/energy_debt.hpp"

#include <algorithm>

#include "contact/patch_table.hpp"

namespace pliant {

void carry_forces(const Model& model, const Patch& old, const PatchForces& from, const Patch& now, PatchForces& to) {
  thread_local PatchForces aside[2];  // their memory is found once
  for (int side = 0; side < 2; ++side) {
    const int begin = old.entry[side], end = begin + old.forces(side).count;
    aside[side].x.assign(from.x.begin() + begin, from.x.begin() + end);
    aside[side].y.assign(from.y.begin() + begin, from.y.begin() + end);
  }
  for (int side = 0; side < 2; ++side) {
    double *x = &to.x[now.entry[side]], *y = &to.y[now.entry[side]];
    std::fill_n(x, padded(now.forces(side).count), 0.0);
    std::fill_n(y, padded(now.forces(side).count), 0.0);
    // Of a small body both arcs may go all the way around and show some nodes twice: what either place had counts once.
    for_each_shared(model, now, side, now.forces(side), old.forces(side), [&](int at, int before, int count) {
      for (int i = 0; i < count; ++i) x[at + i] += aside[side].x[before + i], y[at + i] += aside[side].y[before + i];
    });
  }
}

}  // namespace pliant
