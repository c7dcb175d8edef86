#include "contact/pair_queries.hpp"

#include <algorithm>
#include <vector>

#include "contact/half_pass.hpp"
#include "contact/segment_pass.hpp"
#include "contact/segment_stiffness.hpp"
#include "contact/slip.hpp"

namespace pliant {

double touching_length(const PairView& view) {
  if (view.contact_pair.integrated) return integrated_length(view);
  Lanes length{};
  for_each_projection(view, 0, [&](const HalfPass& pass, int, int i, const Projection& p) {
    const LaneBits touching = first_lanes(pass.nodes.count - i) & p.hit & (p.gap < 0.0);
    length += select(touching, 0.5 * load_slaves(pass, i).tributary_length, Lanes{});
  });
  return sum(length);
}

void locate_new_contacts(const PairView& view, ContactHistory& history) {
  const bool shears = std::visit([](const auto& l) { return l.has_shear; }, view.contact_pair.law);
  if (!shears || view.contact_pair.integrated) return;
  for_each_projection(view, reach_of(view.contact_pair.law) + view.skin,
                      [&](const HalfPass& pass, int, int i, const Projection& p) {
                        Lanes& place = history.at(pass.record + i)[ContactHistory::place];
                        place = select(p.hit & (place != place), place_of(p), place);
                      });
}

bool overlaps(const PairView& view) {
  if (view.contact_pair.integrated) return touching_length(view) > 0;
  bool found = false;
  for_each_projection(view, 0, [&](const HalfPass& pass, int, int i, const Projection& p) {
    found |= any(first_lanes(pass.nodes.count - i) & p.hit & (p.gap < 0.0));
  });
  return found;
}

namespace {

/// Stiffness that slaves put on the nodes of a master, N/m2 per metre, by rows of the window: the sum at present
/// positions, and the largest of a single slave where it may slide to before the next search. The latter is larger if
/// the slave is coarser.
class Carried {
 public:
  void clear(int rows) {
    all_.assign(static_cast<std::size_t>(rows), 0.0);
    single_.assign(static_cast<std::size_t>(rows), 0.0);
  }
  /// `slid`: number of segments by which the slave may slide.
  void add(int row, double share, double slid, double stiffness) {
    if (row < 0 || row >= static_cast<int>(all_.size())) return;
    all_[row] += std::max(share, 0.0) * stiffness;
    single_[row] = std::max(single_[row], std::clamp(share + slid, 0.0, 1.0) * stiffness);
  }
  /// A rigid body bears the sum, wherever it acts.
  void add_to(BodyKind kind, double* entries) const {
    for (std::size_t row = 0; row < all_.size(); ++row)
      entries[row] += kind == BodyKind::rigid ? all_[row] : std::max(all_[row], single_[row]);
  }

 private:
  std::vector<double> all_, single_;
};

/// Adds a slave that projects on a row to its nodes, and to the next ones, which it may reach.
void add_projected(const Projection& p, int lane, double skin, double stiffness, Carried& carried) {
  const int row = static_cast<int>(p.row[lane]);
  const double slid = skin / p.length[lane];
  carried.add(row - 1, -p.xi[lane], slid, stiffness);
  carried.add(row, 1 - p.xi[lane], slid, stiffness);
  carried.add(row + 1, p.xi[lane], slid, stiffness);
  carried.add(row + 2, p.xi[lane] - 1, slid, stiffness);
}

/// Adds one half pass: half the tributary lengths times the stiffness.
void add_pass_stiffness(const PairView& view, int slave_side, const double (&factor)[2], LinedNumbers& entries) {
  const double stiffness = stiffness_of(view.contact_pair.law), outward = reach_of(view.contact_pair.law) + view.skin;
  const HalfPass pass = make_half_pass(view, slave_side, runs_in_table(view.contact_pair));
  fill_window(view, 1 - slave_side);
  thread_local Carried carried;
  carried.clear(view.window.count() + 1);
  for (int i = 0; i < pass.nodes.count; i += lane_count) {
    const SlaveNodes nodes = load_slaves(pass, i);
    const Projection p = project(view.window, nodes.x, nodes.y, outward);
    for (int lane = 0; lane < std::min(lane_count, pass.nodes.count - i); ++lane) {
      if (!p.hit[lane] || p.gap[lane] > outward) continue;  // far beyond an end; the arc has only some of these
      const double k = 0.5 * nodes.tributary_length[lane] * stiffness;
      entries[pass.slave_force + i + lane] += factor[slave_side] * k;
      add_projected(p, lane, view.skin, factor[1 - slave_side] * k, carried);
    }
  }
  carried.add_to(view.model.bodies[view.body(1 - slave_side)].kind, &entries[pass.master_force]);
}

}  // namespace

void add_patch_stiffness(const PairView& view, const double (&factor)[2], LinedNumbers& entries) {
  if (view.contact_pair.integrated) return add_integrated_stiffness(view, factor, entries);
  for (int slave_side = 0; slave_side < 2; ++slave_side)
    if (view.contact_pair.nodes[slave_side].count > 0) add_pass_stiffness(view, slave_side, factor, entries);
}

}  // namespace pliant
