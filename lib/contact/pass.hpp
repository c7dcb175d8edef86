#pragma once

#include <algorithm>

#include "bodies/model.hpp"
#include "contact/patch_forces.hpp"

namespace pliant {

/// One pass: the slave's nodes and the buffers of both sides.
struct Pass {
  const OutlineShape *slave, *master;
  const double* slave_x;
  const double* slave_y;
  Arc nodes;
  double slave_shift;
  int record;
  int slave_force;                 ///< buffer entry of the first node
  int master_force;                ///< buffer entry of the window's first row
  const double* tributary_length;  ///< [nodes] of the slave, m
  bool present_lengths;            ///< as the slave's outline is now
  bool corners;                    ///< of either outline
  // For dashpots only:
  const double *slave_vx = nullptr, *slave_vy = nullptr, *master_vx = nullptr, *master_vy = nullptr;
  double damping = 0;  ///< Pa s/m
};

struct SlaveNodes {
  Lanes x, y, tributary_length;
};

/// Eight consecutive slave nodes from position i of the arc.
inline SlaveNodes load_slaves(const Pass& pass, int i) {
  const int index = pass.nodes.begin + i;
  const int turn = turn_of(index, pass.slave->count);
  const int node = index - turn * pass.slave->count;
  return {load(pass.slave_x + node) + (pass.slave_shift + turn * pass.slave->turn_shift), load(pass.slave_y + node),
          load(pass.tributary_length + node)};
}

/// Pass 0: the first body's nodes on the second's segments; pass 1: the other way round.
inline Pass make_pass(const Model& model, const Outlines& outlines, const Patch& patch, int slave_side) {
  const int slave = slave_side == 0 ? patch.first : patch.second, master = slave_side == 0 ? patch.second : patch.first;
  const double shift = patch.images * model.scene.period.value_or(0);
  const int offset = model.outline_offset[slave], master_side = 1 - slave_side;
  const bool present_lengths = !outlines.tributary_length.empty();
  return {&model.outline_of(slave),
          &model.outline_of(master),
          &outlines.position.x[offset],
          &outlines.position.y[offset],
          patch.nodes[slave_side],
          slave_side == 0 ? 0.0 : shift,
          patch.record[slave_side],
          patch.force[slave_side] + patch.nodes[slave_side].begin - patch.forces(slave_side).begin,
          patch.force[master_side] + patch.segments[master_side].begin - patch.forces(master_side).begin,
          present_lengths ? &outlines.tributary_length[offset] : model.outline_of(slave).tributary_length.data(),
          present_lengths,
          patch.corners};
}

inline void fill_window(const Model& model, const Outlines& outlines, const Patch& patch, int master_side, double skin,
                        MasterWindow& window) {
  const int master = master_side == 0 ? patch.first : patch.second;
  const double shift = master_side == 0 ? 0.0 : patch.images * model.scene.period.value_or(0);
  const int offset = model.outline_offset[master];
  window.fill(model.outline_of(master), &outlines.position.x[offset], &outlines.position.y[offset],
              patch.segments[master_side], shift, skin);
}

inline void clear_forces(const Patch& patch, PatchForces& forces) {
  for (int side = 0; side < 2; ++side) {
    std::fill_n(forces.x.begin() + patch.force[side], patch.forces(side).count, 0.0);
    std::fill_n(forces.y.begin() + patch.force[side], patch.forces(side).count, 0.0);
  }
}

}  // namespace pliant
