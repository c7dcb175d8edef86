#pragma once

#include <array>

#include "contact/contact_pair.hpp"
#include "contact/master_window.hpp"
#include "contact/projection.hpp"

namespace pliant {

/// One half pass: the slave's nodes and the force buffers of both sides.
struct HalfPass {
  int slave_side;
  const OutlineShape *slave, *master;
  const double* slave_x;
  const double* slave_y;
  Arc nodes;
  int segments;  ///< slave segments from the first node on, if contact is integrated over them
  Vec2 slave_shift;
  int record;
  int slave_force;                 ///< buffer entry of the first node
  int master_force;                ///< buffer entry of the window's first row
  Arc rows;                        ///< rows of the window that can be touched
  const double* tributary_length;  ///< [nodes] of the slave, m
  bool present_lengths;            ///< whether lengths are those of the current outline
  // For dashpots only:
  const double *slave_vx = nullptr, *slave_vy = nullptr, *master_vx = nullptr, *master_vy = nullptr;
  Vec2 image_velocity{0, 0};  ///< of the slave's image less that of the master's, m/s
  double damping = 0;         ///< Pa s/m
  double dt = 0;              ///< see PairView, s
};

struct SlaveNodes {
  Lanes x, y, tributary_length;
};

/// Eight consecutive slave nodes from position i of the arc.
inline SlaveNodes load_slaves(const HalfPass& pass, int i) {
  const int index = pass.nodes.begin + i;
  const int turn = turn_of(index, pass.slave->count);
  const int node = index - turn * pass.slave->count;
  return {load(pass.slave_x + node) + (pass.slave_shift.x() + turn * pass.slave->turn_shift),
          load(pass.slave_y + node) + pass.slave_shift.y(), load(pass.tributary_length + node)};
}

/// Nodes of one side that receive forces; `begin`: the first node's entry in a buffer.
struct ForceRun {
  Arc arc;
  int begin;
};
using ForceRuns = std::array<ForceRun, 2>;  ///< [sides]
/// Ranges in the buffers of all contact pairs.
inline ForceRuns runs_in_table(const ContactPair& contact_pair) {
  return {{{contact_pair.forces(0), contact_pair.entry[0]}, {contact_pair.forces(1), contact_pair.entry[1]}}};
}

/// Half pass 0: the first body's nodes on the second's segments; half pass 1: the reverse.
inline HalfPass make_half_pass(const PairView& view, int slave_side, const ForceRuns& runs) {
  const Model& model = view.model;
  const ContactPair& contact_pair = view.contact_pair;
  const int master_side = 1 - slave_side, slave = view.body(slave_side), offset = model.outline_offset[slave];
  const std::vector<double>& present = view.outlines.tributary_length;
  return {slave_side,
          &model.outline_of(slave),
          &model.outline_of(view.body(master_side)),
          &view.outlines.position.x[offset],
          &view.outlines.position.y[offset],
          contact_pair.nodes[slave_side],
          contact_pair.slave_segments[slave_side],
          view.shift(slave_side),
          contact_pair.record[slave_side],
          runs[slave_side].begin + contact_pair.nodes[slave_side].begin - runs[slave_side].arc.begin,
          runs[master_side].begin + contact_pair.window[master_side].begin - runs[master_side].arc.begin,
          {contact_pair.segments[master_side].begin - contact_pair.window[master_side].begin,
           contact_pair.segments[master_side].count},
          present.empty() ? model.outline_of(slave).tributary_length.data() : &present[offset],
          !present.empty()};
}

/// `before`: the outlines at the start of the step, for lengths that change in it; null: not needed.
inline void fill_window(const PairView& view, int master_side, const OutlineField* before = nullptr) {
  const int master = view.body(master_side), offset = view.model.outline_offset[master];
  const auto in = [&](const OutlineField& at) { return std::array{&at.x[offset], &at.y[offset]}; };
  const auto [x, y] = in(view.outlines.position);
  const bool stretches = before && view.model.bodies[master].rigid < 0;
  view.window.fill(view.model.outline_of(master), x, y, view.contact_pair.window[master_side], view.shift(master_side),
                   view.skin, stretches ? in(*before) : std::array<const double*, 2>{});
}

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
