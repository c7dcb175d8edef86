#pragma once

#include "contact/half_pass.hpp"
#include "contact/projection.hpp"

namespace pliant {

/// Calls visit(pass, slave side, i, projection) for each eight slave nodes, from position i of the pass on, of which
/// some project onto the master, at most `outward` away, m.
template <class Visit>
void for_each_projection(const PairView& view, double outward, Visit&& visit) {
  const ForceRuns runs = runs_in_table(view.contact_pair);
  for (int slave_side = 0; slave_side < 2; ++slave_side) {
    if (view.contact_pair.nodes[slave_side].count == 0) continue;
    const HalfPass pass = make_half_pass(view, slave_side, runs);
    fill_window(view, 1 - slave_side);
    for (int i = 0; i < pass.nodes.count; i += lane_count) {
      const SlaveNodes nodes = load_slaves(pass, i);
      const Projection p = project(view.window, nodes.x, nodes.y, outward);
      if (any(p.hit)) visit(pass, slave_side, i, p);
    }
  }
}

}  // namespace pliant
