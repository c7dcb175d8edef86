#include "contact/pair_forces.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "contact/energy_correction.hpp"
#include "contact/half_pass.hpp"
#include "contact/pair_queries.hpp"
#include "contact/reactions.hpp"
#include "contact/segment_pass.hpp"
#include "contact/slip.hpp"

namespace pliant {
namespace {

/// PairTotals before the lanes are added up.
struct LaneTotals {
  Lanes stored{}, dissipated{}, damping_power{}, pressures{}, shears{}, deepest{};  // pressures, shears: squared
  int contacts = 0;
};

void add(double* to, Lanes value) { store(to, load(to) + value); }

/// Rate of the gaps of nodes in contact, m/s: of the motion on which forces on the slave and both segment nodes do
/// work.
Lanes gap_rate(const HalfPass& pass, int i, const Projection& p, LaneBits touching) {
  const int index = pass.nodes.begin + i, node = index - turn_of(index, pass.slave->count) * pass.slave->count;
  Lanes rate{};
  for (unsigned left = bits(touching); left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left), foot = static_cast<int>(p.number[lane]);
    const auto relative = [&](const double* slave, const double* master, double of_image) {
      return slave[node + lane] - (1 - p.xi[lane]) * master[foot] - p.xi[lane] * master[foot + 1] + of_image;
    };
    rate[lane] = p.normal_x[lane] * relative(pass.slave_vx, pass.master_vx, pass.image_velocity.x()) +
                 p.normal_y[lane] * relative(pass.slave_vy, pass.master_vy, pass.image_velocity.y());
  }
  return rate;
}

/// Adds the dashpot's pressure and its friction. Returns its power on the weights, W/m.
template <class Law>
Lanes add_damping(const Law& law, const HalfPass& pass, int i, const Projection& p, LaneBits touching, Lanes weight,
                  Traction& traction) {
  const Lanes rate = gap_rate(pass, i, p, touching);
  const Lanes damping = law.damping_pressure(traction.pressure, p.gap, rate, pass.damping, pass.dt);
  add_pressure(law, damping, traction);
  return select(touching, -weight * damping * rate, Lanes{});
}

/// Forces on slave nodes, N/m. The couple is that of shears that act at the gap's distance from the master, over the
/// length of its segment.
struct Force {
  Lanes x, y, couple;
};

/// Forces on slave nodes. The tangent is perpendicular to the normal, also to a radial one.
Force force_on(const Projection& p, Lanes weight, Lanes pressure, Lanes shear) {
  const Lanes couple = weight * shear * p.gap * p.inverse_length;
  return {weight * (pressure * p.normal_x - shear * p.normal_y), weight * (pressure * p.normal_y + shear * p.normal_x),
          couple};
}

/// Histories, forces and sums of the half passes of a contact pair.
struct Accounts {
  const ContactHistory& from;
  ContactHistory& to;
  PairForceBuffer& forces;
  LaneTotals totals = {};
};

template <class Law>
void compute_half_pass(const Law& law, const HalfPass& pass, const PairView& view, Accounts& accounts) {
  auto& [from, to, forces, totals] = accounts;
  const MasterWindow& window = view.window;
  thread_local Reactions reactions;
  reactions.clear(window.count());
  const double inverse_longest = 1 / window.longest();
  const double outward = law.reach + view.skin;  // to know places before contact
  for (int i = 0; i < pass.nodes.count; i += lane_count) {
    const int record = pass.record + i;
    const Lanes* before = from.at(record);
    Lanes* after = to.at(record);
    const LaneBits active = first_lanes(pass.nodes.count - i);
    const SlaveNodes nodes = load_slaves(pass, i);
    const Projection p = project(window, nodes.x, nodes.y, outward);
    const Lanes half_length = select(active, 0.5 * nodes.tributary_length, Lanes{});
    const Lanes old_slip = before[ContactHistory::slip];
    if (!any(p.hit)) {
      totals.dissipated += half_length * set_free(law, old_slip);
      to.clear(record, lane_count);
      continue;
    }
    const LaneBits touching = active & p.hit & (p.gap < law.reach);
    const Lanes place = place_of(p);
    Traction traction = law(p.gap);
    if constexpr (has_dashpot<Law>)
      totals.damping_power += add_damping(law, pass, i, p, touching, half_length, traction);
    const FormerPlaces former{before[ContactHistory::place], view, pass, i};
    const Contact c =
        respond(law, traction, touching, old_slip, slip_increment(law, window, p, touching, former, place));
    after[ContactHistory::place] = select(p.hit, place, broadcast(ContactHistory::nowhere));
    after[ContactHistory::slip] = select(touching, c.slip, Lanes{});
    totals.dissipated += half_length * c.slip_work;
    if (!any(touching)) continue;
    const Lanes pressure = select(touching, c.pressure, Lanes{}), shear = select(touching, c.shear, Lanes{});
    totals.stored += select(touching, half_length * c.energy, Lanes{});
    totals.pressures += half_length * pressure * pressure;
    if constexpr (Law::has_shear) totals.shears += half_length * shear * shear;
    totals.deepest = max(totals.deepest, select(touching, -inverse_longest * p.gap, Lanes{}));
    const Force force = force_on(p, select(touching, half_length, Lanes{}), pressure, shear);
    reactions.add(p, force.x, force.y, force.couple);
    add(&forces.x[pass.slave_force + i], force.x), add(&forces.y[pass.slave_force + i], force.y);
    totals.contacts += std::popcount(bits(touching));
  }
  reactions.add_to(&forces.x[pass.master_force], &forces.y[pass.master_force]);
}

void load_velocities(const PairView& view, int slave_side, HalfPass& pass) {
  const OutlineField& velocity = view.outlines.velocity;
  const int slave = view.model.outline_offset[view.body(slave_side)],
            master = view.model.outline_offset[view.body(1 - slave_side)];
  pass.slave_vx = &velocity.x[slave], pass.slave_vy = &velocity.y[slave];
  pass.master_vx = &velocity.x[master], pass.master_vy = &velocity.y[master];
  pass.image_velocity = view.image_of(velocity, slave_side) - view.image_of(velocity, 1 - slave_side);
}

/// Both half passes of a contact pair. Sums that a law does not need are skipped.
template <class Law>
PairTotals compute_half_passes(const Law& law, const PairView& view, const ForceRuns& runs, Accounts accounts) {
  double damping = 0;
  if constexpr (has_dashpot<Law>)
    if (const double length = touching_length(view); length > 0) damping = law.root_damping / std::sqrt(length);
  for (int slave_side = 0; slave_side < 2; ++slave_side) {
    if (view.contact_pair.nodes[slave_side].count == 0) continue;
    HalfPass pass = make_half_pass(view, slave_side, runs);
    if constexpr (has_dashpot<Law>) {
      load_velocities(view, slave_side, pass);
      pass.damping = damping, pass.dt = view.dt;
    }
    fill_window(view, 1 - slave_side, Law::has_shear ? view.before : nullptr);
    compute_half_pass(law, pass, view, accounts);
  }
  const LaneTotals& totals = accounts.totals;
  double damping_power = 0;
  if constexpr (has_dashpot<Law>) damping_power = sum(totals.damping_power);
  PairTotals result{sum(totals.stored), sum(totals.dissipated), damping_power, largest(totals.deepest),
                    totals.contacts};
  result.traction_norm = sum(totals.pressures) / law.normal_stiffness;
  if constexpr (Law::has_shear) result.traction_norm += sum(totals.shears) / law.shear_stiffness;
  return result;
}

/// Work of a side's forces at the start and at the end of a step over its displacements: the rest of PairTotals.
class StepWork {
 public:
  StepWork(const PairView& view, const PairStep& step, int side)
      : now_(view.outlines.position),
        step_(step),
        rigid_(step.rigid[side]),
        of_image_(view.image_of(now_, side) - view.image_of(*step.before, side)) {
    const double now = 0.125 * step.dt * step.dt, before = 0.125 * step.dt_before * step.dt_before;
    for (int c = 0; rigid_ && c < 3; ++c)
      kept_by_force_[c] = before * rigid_->acceleration_before[c] - now * rigid_->acceleration[c];
  }

  /// Adds a vector of nodes from `node` on, whose entries in force buffers begin at `entry`, with their present forces.
  void add(std::size_t node, std::size_t entry, Lanes x, Lanes y) {
    const Lanes old_x = load(&step_.forces_before.x[entry]), old_y = load(&step_.forces_before.y[entry]);
    const Lanes x0 = load(&step_.before->x[node]), y0 = load(&step_.before->y[node]), x1 = load(&now_.x[node]),
                y1 = load(&now_.y[node]);
    if (!rigid_) {
      const Lanes displacement_x = x1 - x0 + of_image_.x(), displacement_y = y1 - y0 + of_image_.y();
      add_in_order(old_x * displacement_x + old_y * displacement_y, before_);
      add_in_order(x * displacement_x + y * displacement_y, now_work_);
      return;
    }
    const RigidStep& r = *rigid_;
    const double displacement_x = r.to.x() - r.from.x() + of_image_.x(),
                 displacement_y = r.to.y() - r.from.y() + of_image_.y();
    const Lanes arm_x = x0 - r.from.x(), arm_y = y0 - r.from.y();
    add_in_order(old_x * (displacement_x - r.turn * arm_y) + old_y * (displacement_y + r.turn * arm_x), before_);
    add_in_order(x * (displacement_x - r.turn * (y1 - r.to.y())) + y * (displacement_y + r.turn * (x1 - r.to.x())),
                 now_work_);
    const auto& [kept_x, kept_y, kept_turn] = kept_by_force_;
    add_in_order(old_x * (kept_x - kept_turn * arm_y) + old_y * (kept_y + kept_turn * arm_x), kept_);
  }
  void add_to(PairTotals& totals) const {
    totals.work_before += before_, totals.work += now_work_, totals.step_change += kept_;
  }

 private:
  const OutlineField& now_;
  const PairStep& step_;
  const RigidStep* rigid_;
  Vec2 of_image_;                 ///< displacement of the side's image relative to its body, m
  double kept_by_force_[3] = {};  ///< of a unit force or moment on a rigid body, m or 1
  double before_ = 0, now_work_ = 0, kept_ = 0;
};

/// Copies one side's forces into the buffer of all contact pairs, in whole lanes, 0 beyond the last node. `work`: null
/// if not needed.
void put_out(const PairView& view, StepWork* work, int side, const ForceRun& run, const PairForceBuffer& near,
             PairForceBuffer& forces) {
  const int entry = view.contact_pair.entry[side], body = view.body(side), n = view.model.outline_of(body).count,
            offset = view.model.outline_offset[body];
  int node = run.arc.begin;
  for (int i = 0; i < run.arc.count; i += lane_count, node += lane_count) {
    const Lanes x = load(&near.x[run.begin + i]), y = load(&near.y[run.begin + i]);
    store(&forces.x[entry + i], x), store(&forces.y[entry + i], y);
    if (!work) continue;
    node -= turn_of(node, n) * n;
    work->add(static_cast<std::size_t>(offset + node), static_cast<std::size_t>(entry + i), x, y);
  }
}

}  // namespace

PairTotals compute_pair(const PairView& view, const PairStep* step, const ContactHistory& from, ContactHistory& to,
                        PairForceBuffer& forces) {
  // Both half passes add to both sides, in a small buffer; the results are copied to the large one once.
  thread_local PairForceBuffer near;
  const ContactPair& contact_pair = view.contact_pair;
  ForceRuns runs = runs_in_table(contact_pair);
  runs[0].begin = 0, runs[1].begin = padded(runs[0].arc.count) + lane_count;
  const std::size_t size = static_cast<std::size_t>(runs[1].begin + padded(runs[1].arc.count) + lane_count);
  clear(near.x, size);
  clear(near.y, size);
  const auto passes = [&](const auto& law) { return compute_half_passes(law, view, runs, Accounts{from, to, near}); };
  PairTotals totals =
      contact_pair.integrated ? integrate_pair(view, runs, from, to, near) : std::visit(passes, contact_pair.law);
  // The second half pass has just added single numbers to the first side. Loads of whole lanes wait for these, so that
  // side is copied last.
  for (const int side : {1, 0}) {
    std::optional<StepWork> work;
    if (step) work.emplace(view, *step, side);
    put_out(view, work ? &*work : nullptr, side, runs[side], near, forces);
    if (work) work->add_to(totals);
  }
  return totals;
}

}  // namespace pliant
