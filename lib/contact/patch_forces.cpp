#include "contact/patch_forces.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "contact/slip.hpp"

namespace pliant {
namespace {

/// One pass: the slave's nodes and the buffers of both sides.
struct Pass {
  const OutlineShape* slave;
  const double* slave_x;
  const double* slave_y;
  Arc nodes;
  double slave_shift;
  int record;
  int slave_force;   ///< buffer entry of the first node
  int master_force;  ///< buffer entry of the window's first row
};

struct SlaveNodes {
  Lanes x, y, tributary_length;
};

/// Eight consecutive slave nodes from position i of the arc.
SlaveNodes load_slaves(const Pass& pass, int i) {
  const int index = pass.nodes.begin + i;
  const int turn = turn_of(index, pass.slave->count);
  const int node = index - turn * pass.slave->count;
  return {load(pass.slave_x + node) + (pass.slave_shift + turn * pass.slave->turn_shift), load(pass.slave_y + node),
          load(pass.slave->tributary_length.data() + node)};
}

/// Traction of eight nodes, with the tangential part brought up to date.
struct Contact {
  Lanes pressure, shear, energy;  ///< shear acts on the slave along the tangent
  Lanes slip, slip_work;          ///< slip_work: dissipated per length, J/m2
};

template <class Law>
Contact respond(const Law& law, const MasterWindow& window, const Projection& p, LaneBits touching, Lanes place,
                Lanes old_place, Lanes old_slip) {
  const Traction traction = law(p.gap);
  Contact c{traction.pressure, {}, traction.energy, {}, {}};
  if constexpr (Law::has_shear) {
    const Lanes trial = old_slip + moved_along(window, p, touching & (old_place == old_place), old_place, place);
    const Lanes largest = select(touching, traction.shear_limit * (1 / law.shear_stiffness), Lanes{});
    c.slip = min(max(trial, -largest), largest);
    c.shear = -law.shear_stiffness * c.slip;
    // Mean of the old and the new traction times the plastic slip: what the tangential forces do, less what is stored.
    c.slip_work = (0.5 * law.shear_stiffness) * (old_slip + c.slip) * (trial - c.slip);
    c.energy += 0.5 * law.shear_stiffness * c.slip * c.slip;
  }
  return c;
}

/// Adds the reaction to the two segment nodes. The couple balances the moment of a shear that acts at the gap's distance, and makes the
/// force the exact conjugate of the slip.
void add_reaction(const Projection& p, LaneBits touching, Lanes fx, Lanes fy, Lanes couple, int base,
                  PatchForces& forces) {
  const Lanes bx = -p.xi * fx + couple * p.tangent_y, by = -p.xi * fy - couple * p.tangent_x;
  double reaction[4][lane_count], row[lane_count];
  store(reaction[0], -fx - bx), store(reaction[1], -fy - by), store(reaction[2], bx), store(reaction[3], by);
  store(row, p.row);
  for (unsigned left = bits(touching); left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left), at = base + static_cast<int>(row[lane]);
    forces.x[at] += reaction[0][lane], forces.y[at] += reaction[1][lane];
    forces.x[at + 1] += reaction[2][lane], forces.y[at + 1] += reaction[3][lane];
  }
}

/// PatchTotals before the lanes are added up.
struct LaneTotals {
  Lanes stored{}, dissipated{}, deepest{};
  int contacts = 0;
};

void add(double* to, Lanes value) { store(to, load(to) + value); }

/// Nodes that left the master: their elastic slip is set free.
template <class Law>
Lanes release(const Law& law, const Pass& pass, int i, Lanes old_slip, ContactHistory& trial) {
  store(&trial.place[pass.record + i], broadcast(std::numeric_limits<double>::quiet_NaN()));
  store(&trial.slip[pass.record + i], Lanes{});
  return (0.5 * law.shear_stiffness) * old_slip * old_slip;
}

template <class Law>
void compute_pass(const Law& law, const Pass& pass, const MasterWindow& window, double skin,
                  const ContactHistory& committed, ContactHistory& trial, PatchForces& forces, LaneTotals& totals) {
  const double inverse_longest = 1 / window.longest();
  const double outward = law.reach + (Law::has_shear ? skin : 0);  // see locate_newcomers
  for (int i = 0; i < pass.nodes.count; i += lane_count) {
    const SlaveNodes nodes = load_slaves(pass, i);
    const LaneBits active = first_lanes(pass.nodes.count - i);
    const Lanes half_length = select(active, 0.5 * nodes.tributary_length, Lanes{});
    const Projection p = project(window, nodes.x, nodes.y, outward);
    const Lanes old_place = load(&committed.place[pass.record + i]), old_slip = load(&committed.slip[pass.record + i]);
    if (!any(p.hit)) {
      totals.dissipated += half_length * release(law, pass, i, old_slip, trial);
      continue;
    }
    const LaneBits touching = active & p.hit & (p.gap < law.reach);
    const Lanes place = place_of(p);
    const Contact c = respond(law, window, p, touching, place, old_place, old_slip);
    store(&trial.place[pass.record + i], select(p.hit, place, broadcast(std::numeric_limits<double>::quiet_NaN())));
    store(&trial.slip[pass.record + i], select(touching, c.slip, Lanes{}));
    totals.dissipated += half_length * c.slip_work;
    if (!any(touching)) continue;
    const Lanes weight = select(touching, half_length, Lanes{});
    totals.stored += select(touching, half_length * c.energy, Lanes{});
    totals.deepest = max(totals.deepest, select(touching, -inverse_longest * p.gap, Lanes{}));
    // The tangent goes with the normal, also where that is radial.
    const Lanes fx = weight * (c.pressure * p.normal_x - c.shear * p.normal_y);
    const Lanes fy = weight * (c.pressure * p.normal_y + c.shear * p.normal_x);
    const Lanes couple = weight * c.shear * p.gap * p.inverse_length;
    add_reaction(p, touching, fx, fy, couple, pass.master_force, forces);
    add(&forces.x[pass.slave_force + i], fx);
    add(&forces.y[pass.slave_force + i], fy);
    totals.contacts += std::popcount(bits(touching));
  }
}

/// Pass 0: the first body's nodes on the second's segments; pass 1: the other way round.
Pass make_pass(const Model& model, const Outlines& outlines, const Patch& patch, int slave_side) {
  const int slave = slave_side == 0 ? patch.first : patch.second;
  const double shift = patch.images * model.scene.period.value_or(0);
  const int offset = outlines.offset[slave], master_side = 1 - slave_side;
  return {&model.outlines[outlines.shape[slave]],
          &outlines.x[offset],
          &outlines.y[offset],
          patch.nodes[slave_side],
          slave_side == 0 ? 0.0 : shift,
          patch.record[slave_side],
          patch.force[slave_side] + patch.nodes[slave_side].begin - patch.forces(slave_side).begin,
          patch.force[master_side] + patch.segments[master_side].begin - patch.forces(master_side).begin};
}

void fill_window(const Model& model, const Outlines& outlines, const Patch& patch, int master_side, double skin,
                 MasterWindow& window) {
  const int master = master_side == 0 ? patch.first : patch.second;
  const double shift = master_side == 0 ? 0.0 : patch.images * model.scene.period.value_or(0);
  const int offset = outlines.offset[master];
  window.fill(model.outlines[outlines.shape[master]], &outlines.x[offset], &outlines.y[offset],
              patch.segments[master_side], shift, skin);
}

void clear_forces(const Patch& patch, PatchForces& forces) {
  for (int side = 0; side < 2; ++side) {
    std::fill_n(forces.x.begin() + patch.force[side], patch.forces(side).count, 0.0);
    std::fill_n(forces.y.begin() + patch.force[side], patch.forces(side).count, 0.0);
  }
}

/// Calls visit(pass, slave side, i, nodes, projection) for each eight slave nodes, from position i on, of which some stand beside the master, at
/// most `outward` off.
template <class Visit>
void for_each_projection(const Model& model, const Outlines& outlines, const Patch& patch, double skin, double outward,
                         MasterWindow& scratch, Visit&& visit) {
  for (int slave_side = 0; slave_side < 2; ++slave_side) {
    if (patch.nodes[slave_side].count == 0) continue;
    const Pass pass = make_pass(model, outlines, patch, slave_side);
    fill_window(model, outlines, patch, 1 - slave_side, skin, scratch);
    for (int i = 0; i < pass.nodes.count; i += lane_count) {
      const SlaveNodes nodes = load_slaves(pass, i);
      if (const Projection p = project(scratch, nodes.x, nodes.y, outward); any(p.hit))
        visit(pass, slave_side, i, nodes, p);
    }
  }
}

}  // namespace

PatchTotals compute_patch(const Model& model, const ContactLaws& laws, const Outlines& outlines, const Patch& patch,
                          double skin, const ContactHistory& committed, ContactHistory& trial, PatchForces& forces,
                          MasterWindow& scratch) {
  LaneTotals totals;
  clear_forces(patch, forces);
  for (int slave_side = 0; slave_side < 2; ++slave_side) {
    if (patch.nodes[slave_side].count == 0) continue;
    const Pass pass = make_pass(model, outlines, patch, slave_side);
    fill_window(model, outlines, patch, 1 - slave_side, skin, scratch);
    std::visit([&](const auto& law) { compute_pass(law, pass, scratch, skin, committed, trial, forces, totals); },
               laws.laws[patch.law]);
  }
  return {sum(totals.stored), sum(totals.dissipated), largest(totals.deepest), totals.contacts};
}

void locate_newcomers(const Model& model, const ContactLaws& laws, const Outlines& outlines, const Patch& patch,
                      double skin, ContactHistory& history, MasterWindow& scratch) {
  const ContactLaw& law = laws.laws[patch.law];
  if (!std::visit([](const auto& l) { return l.has_shear; }, law)) return;
  for_each_projection(model, outlines, patch, skin, reach_of(law) + skin, scratch,
                      [&](const Pass& pass, int, int i, const SlaveNodes&, const Projection& p) {
                        double* place = &history.place[pass.record + i];
                        const Lanes old = load(place);
                        store(place, select(p.hit & (old != old), place_of(p), old));
                      });
}

void compute_patch_stiffness(const Model& model, const Outlines& outlines, const Patch& patch, double stiffness,
                             double skin, double outward, const double (&factor)[2], PatchForces& forces,
                             MasterWindow& scratch) {
  clear_forces(patch, forces);
  const auto add_stiffness = [&](const Pass& pass, int slave_side, int i, const SlaveNodes& nodes,
                                 const Projection& p) {
    for (int lane = 0; lane < std::min(lane_count, pass.nodes.count - i); ++lane) {
      if (!p.hit[lane]) continue;
      const double k = 0.5 * nodes.tributary_length[lane] * stiffness;
      const int at = pass.master_force + static_cast<int>(p.row[lane]);
      forces.x[pass.slave_force + i + lane] += factor[slave_side] * k;
      forces.x[at] += factor[1 - slave_side] * (1 - p.xi[lane]) * k;
      forces.x[at + 1] += factor[1 - slave_side] * p.xi[lane] * k;
    }
  };
  for_each_projection(model, outlines, patch, skin, outward, scratch, add_stiffness);
}

}  // namespace pliant
