#include "contact/patch_forces.hpp"

#include <algorithm>
#include <limits>

namespace pliant {
namespace {

/// One pass: the slave's nodes and the buffers of both sides.
struct Pass {
  const OutlineShape* slave;
  const double* slave_x;
  const double* slave_y;
  Arc arc;
  double slave_shift;
  int record;
  int slave_force;   ///< buffer entry of the arc's first node
  int master_force;  ///< buffer entry of local window node 1
  double master_perimeter;
};

struct SlaveNodes {
  Lanes x, y, tributary_length;
};

/// Eight consecutive slave nodes from position i of the arc.
SlaveNodes load_slaves(const Pass& pass, int i) {
  const int index = pass.arc.begin + i;
  const int turn = turn_of(index, pass.slave->count);
  const int node = index - turn * pass.slave->count;
  return {load(pass.slave_x + node) + (pass.slave_shift + turn * pass.slave->turn_shift), load(pass.slave_y + node),
          load(pass.slave->tributary_length.data() + node)};
}

/// Traction of eight nodes, with the tangential part brought up to date.
struct Contact {
  Lanes pressure, shear, energy;  ///< shear acts on the slave along the tangent
  Lanes arc, slip, slip_work;     ///< slip_work: dissipated per length, J/m2
};

template <class Law>
Contact respond(const Law& law, const Projection& p, const ContactPoint& point, LaneBits touching, Lanes old_arc,
                Lanes old_slip, double perimeter) {
  const Traction traction = law(point.gap);
  Contact c{traction.pressure, {}, traction.energy, p.arc + point.xi * p.reference_length, {}, {}};
  if constexpr (Law::has_shear) {
    const LaneBits known = old_arc == old_arc;
    const Lanes start = select(known, old_slip, Lanes{});
    Lanes moved = select(known & touching, c.arc - old_arc, Lanes{});
    moved -= perimeter * round_to_integer(moved * (1 / perimeter));
    // Slip is measured in current length: reference arc times the segment's stretch.
    const Lanes trial = start + moved * (p.length / select(touching, p.reference_length, broadcast(1)));
    const Lanes largest = select(touching, traction.shear_limit * (1 / law.shear_stiffness), Lanes{});
    c.slip = min(max(trial, -largest), largest);
    c.shear = -law.shear_stiffness * c.slip;
    // Mean of the old and the new traction times the plastic slip: what the tangential forces do, less what is stored.
    c.slip_work = (0.5 * law.shear_stiffness) * (start + c.slip) * (trial - c.slip);
    c.energy += 0.5 * law.shear_stiffness * c.slip * c.slip;
  }
  return c;
}

/// Adds the reaction to the two segment nodes. The couple balances the moment of a shear that acts at the gap's distance, and makes the
/// force the exact conjugate of the slip.
void add_reaction(const Projection& p, const ContactPoint& point, LaneBits touching, Lanes fx, Lanes fy, Lanes couple,
                  int base, PatchForces& forces) {
  const Lanes bx = -point.xi * fx + couple * p.tangent_y, by = -point.xi * fy - couple * p.tangent_x;
  const Lanes ax = -fx - bx, ay = -fy - by;
  for (int lane = 0; lane < lane_count; ++lane) {
    if (!touching[lane]) continue;
    const int at = base + static_cast<int>(p.segment[lane]) - 1;
    forces.x[at] += ax[lane], forces.y[at] += ay[lane];
    forces.x[at + 1] += bx[lane], forces.y[at + 1] += by[lane];
  }
}

template <class Law>
void compute_pass(const Law& law, const Pass& pass, const MasterWindow& window, const ContactHistory& committed,
                  ContactHistory& trial, PatchForces& forces, PatchTotals& totals) {
  Lanes stored{}, dissipated{}, deepest{};
  // Where a node projects is known before it touches, so that friction acts from the first step of a touch.
  const double outward = Law::has_shear ? std::max(law.reach, 0.5 * window.longest) : law.reach;
  for (int i = 0; i < pass.arc.count; i += lane_count) {
    const SlaveNodes nodes = load_slaves(pass, i);
    const LaneBits active = first_lanes(pass.arc.count - i);
    const Projection p = project(window, nodes.x, nodes.y, outward);
    const ContactPoint point = locate(p);
    const LaneBits touching = active & p.hit & (point.gap < law.reach);
    const Lanes old_arc = load(&committed.arc[pass.record + i]), old_slip = load(&committed.slip[pass.record + i]);
    const Contact c = respond(law, p, point, touching, old_arc, old_slip, pass.master_perimeter);
    store(&trial.arc[pass.record + i], select(p.hit, c.arc, broadcast(std::numeric_limits<double>::quiet_NaN())));
    store(&trial.slip[pass.record + i], select(touching, c.slip, Lanes{}));
    const Lanes half_length = 0.5 * nodes.tributary_length;
    dissipated += select(active, half_length * c.slip_work, Lanes{});
    if (!any(touching)) continue;
    const Lanes weight = select(touching, half_length, Lanes{});
    stored += weight * c.energy;
    const Lanes length = select(touching, p.length, broadcast(1));
    deepest = max(deepest, select(touching, -point.gap / length, Lanes{}));
    // The tangent goes with the normal, also where that is radial.
    const Lanes fx = weight * (c.pressure * point.normal_x - c.shear * point.normal_y);
    const Lanes fy = weight * (c.pressure * point.normal_y + c.shear * point.normal_x);
    const Lanes couple = weight * c.shear * point.gap / length;
    add_reaction(p, point, touching, fx, fy, couple, pass.master_force, forces);
    double* slave_x = &forces.x[pass.slave_force + i];
    double* slave_y = &forces.y[pass.slave_force + i];
    for (int lane = 0; lane < std::min(lane_count, pass.arc.count - i); ++lane) {
      slave_x[lane] += fx[lane];
      slave_y[lane] += fy[lane];
      totals.contacts += touching[lane] != 0;
    }
  }
  totals.stored += sum(stored);
  totals.dissipated += sum(dissipated);
  totals.deepest = std::max(totals.deepest, largest(deepest));
}

/// Pass 0: the first body's nodes on the second's segments; pass 1: the other way round.
Pass make_pass(const Model& model, const Outlines& outlines, const Patch& patch, int slave_side) {
  const int slave = slave_side == 0 ? patch.first : patch.second;
  const int master = slave_side == 0 ? patch.second : patch.first;
  const double shift = patch.images * model.scene.period.value_or(0);
  const int offset = outlines.offset[slave];
  return {&model.outlines[outlines.shape[slave]],
          &outlines.x[offset],
          &outlines.y[offset],
          patch.arc[slave_side],
          slave_side == 0 ? 0.0 : shift,
          patch.record[slave_side],
          patch.force[slave_side] + 1,
          patch.force[1 - slave_side],
          model.outlines[outlines.shape[master]].perimeter};
}

void fill_window(const Model& model, const Outlines& outlines, const Patch& patch, int master_side,
                 MasterWindow& window) {
  const int master = master_side == 0 ? patch.first : patch.second;
  const double shift = master_side == 0 ? 0.0 : patch.images * model.scene.period.value_or(0);
  const int offset = outlines.offset[master];
  window.fill(model.outlines[outlines.shape[master]], &outlines.x[offset], &outlines.y[offset], patch.arc[master_side],
              shift);
}

void clear_forces(const Patch& patch, PatchForces& forces) {
  for (int side = 0; side < 2; ++side) {
    std::fill_n(forces.x.begin() + patch.force[side], patch.arc[side].count + 2, 0.0);
    std::fill_n(forces.y.begin() + patch.force[side], patch.arc[side].count + 2, 0.0);
  }
}

}  // namespace

PatchTotals compute_patch(const Model& model, const ContactLaws& laws, const Outlines& outlines, const Patch& patch,
                          const ContactHistory& committed, ContactHistory& trial, PatchForces& forces,
                          MasterWindow& scratch) {
  PatchTotals totals;
  clear_forces(patch, forces);
  for (int slave_side = 0; slave_side < 2; ++slave_side) {
    const Pass pass = make_pass(model, outlines, patch, slave_side);
    fill_window(model, outlines, patch, 1 - slave_side, scratch);
    std::visit([&](const auto& law) { compute_pass(law, pass, scratch, committed, trial, forces, totals); },
               laws.laws[patch.law]);
  }
  return totals;
}

void compute_patch_stiffness(const Model& model, const Outlines& outlines, const Patch& patch, double stiffness,
                             double outward, const double (&factor)[2], PatchForces& forces, MasterWindow& scratch) {
  clear_forces(patch, forces);
  for (int slave_side = 0; slave_side < 2; ++slave_side) {
    const Pass pass = make_pass(model, outlines, patch, slave_side);
    fill_window(model, outlines, patch, 1 - slave_side, scratch);
    for (int i = 0; i < pass.arc.count; i += lane_count) {
      const SlaveNodes nodes = load_slaves(pass, i);
      const Projection p = project(scratch, nodes.x, nodes.y, outward);
      const ContactPoint point = locate(p);
      for (int lane = 0; lane < std::min(lane_count, pass.arc.count - i); ++lane) {
        if (!p.hit[lane]) continue;
        const double k = 0.5 * nodes.tributary_length[lane] * stiffness;
        const int at = pass.master_force + static_cast<int>(p.segment[lane]) - 1;
        forces.x[pass.slave_force + i + lane] += factor[slave_side] * k;
        forces.x[at] += factor[1 - slave_side] * (1 - point.xi[lane]) * k;
        forces.x[at + 1] += factor[1 - slave_side] * point.xi[lane] * k;
      }
    }
  }
}

}  // namespace pliant
