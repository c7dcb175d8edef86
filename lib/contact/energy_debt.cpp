#include "contact/energy_debt.hpp"

#include <algorithm>

#include "contact/patch_table.hpp"

namespace pliant {

double work_of_side(const PatchView& view, const PatchStep& step, int side, const double* force_x,
                    const double* force_y) {
  const Arc arc = view.patch.forces(side);
  const int body = view.body(side), offset = view.model.outline_offset[body], n = view.model.outline_of(body).count;
  const OutlineField &now = view.outlines.position, &before = *step.before;
  const double *before_x = &step.forces_before->x[view.patch.entry[side]],
               *before_y = &step.forces_before->y[view.patch.entry[side]];
  Lanes twice{};
  for (int done = 0; done < arc.count;) {
    const int from = arc.begin + done, first = from - turn_of(from, n) * n, run = std::min(arc.count - done, n - first);
    for (int i = 0; i < run; i += lane_count) {
      const int node = offset + first + i, at = done + i;
      const Lanes x = load(&now.x[node]) - load(&before.x[node]), y = load(&now.y[node]) - load(&before.y[node]);
      const Lanes work =
          (load(force_x + at) + load(before_x + at)) * x + (load(force_y + at) + load(before_y + at)) * y;
      twice += select(first_lanes(run - i), work, Lanes{});
    }
    done += run;
  }
  return 0.5 * sum(twice);
}

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
