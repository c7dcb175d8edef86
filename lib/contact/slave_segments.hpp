#pragma once

#include "contact/pass.hpp"
#include "contact/segment_quadrature.hpp"

namespace pliant {

/// Index in a slave's outline, whose numbers are those of its arrays, of position i of the pass.
inline int slave_index(const Pass& pass, int i) {
  const int index = pass.nodes.begin + i;
  return index - turn_of(index, pass.slave->count) * pass.slave->count;
}

/// Eight consecutive slave segments from position i of the arc.
inline SlaveSegments load_segments(const Pass& pass, int i) {
  const int turn = turn_of(pass.nodes.begin + i, pass.slave->count), node = slave_index(pass, i);
  const double shift = pass.slave_shift + turn * pass.slave->turn_shift;
  SlaveSegments result{load(pass.slave_x + node) + shift,
                       load(pass.slave_y + node),
                       load(pass.slave_x + node + 1) + shift,
                       load(pass.slave_y + node + 1),
                       load(&pass.slave->segment_length[static_cast<std::size_t>(node)]),
                       first_lanes(pass.segments - i)};
  if (pass.present_lengths) {
    const Lanes dx = result.x1 - result.x0, dy = result.y1 - result.y0;
    result.length = sqrt(dx * dx + dy * dy);
  }
  return result;
}

/// Calls visit(pass, slave side) for both passes, with the master's window filled.
template <class Visit>
void for_each_pass(const PatchView& view, const ForceRuns& runs, Visit&& visit) {
  for (int slave_side = 0; slave_side < 2; ++slave_side) {
    if (view.patch.slave_segments[slave_side] == 0) continue;
    Pass pass = make_pass(view, slave_side, runs);
    fill_window(view, 1 - slave_side);
    visit(pass, slave_side);
  }
}

}  // namespace pliant
