#include "contact/patch_queries.hpp"

#include <algorithm>

#include "contact/facing.hpp"
#include "contact/slip.hpp"

namespace pliant {

double touching_length(const PatchView& view) {
  Lanes length{};
  for_each_facing(view, 0, [&](const Pass& pass, int, int i, const Facing& at) {
    const LaneBits touching = first_lanes(pass.nodes.count - i) & at.p.hit & (at.p.gap < 0.0);
    length += select(touching, 0.5 * at.length, Lanes{});
  });
  return sum(length);
}

void locate_newcomers(const PatchView& view, ContactHistory& history) {
  const bool shears = std::visit([](const auto& l) { return l.has_shear; }, view.patch.law);
  if (!shears) return;
  for_each_facing(view, reach_of(view.patch.law) + view.skin, [&](const Pass& pass, int, int i, const Facing& at) {
    double* place = &history.place[pass.record + i];
    const Lanes old = load(place);
    store(place, select(at.p.hit & (old != old), place_of(at.p), old));
  });
}

void start_records(const PatchView& view, ContactHistory& history) {
  const auto start = [&]<class Law>(const Law& law) {
    if constexpr (remembers<Law>)
      for_each_facing(view, law.start_reach(), [&](const Pass& pass, int, int i, const Facing& at) {
        const LaneBits beside = first_lanes(pass.nodes.count - i) & at.p.hit;
        store_record(history, pass.record + i, law.at_start(at.p.gap, beside));
      });
  };
  std::visit(start, view.patch.law);
}

bool overlaps(const PatchView& view) {
  bool found = false;
  for_each_facing(view, 0, [&](const Pass& pass, int, int i, const Facing& at) {
    const Projection& p = at.p;
    found |= any(first_lanes(pass.nodes.count - i) & p.hit & (p.gap < 0.0));
  });
  return found;
}

void add_patch_stiffness(const PatchView& view, const double (&factor)[2], std::vector<double>& entries) {
  const double stiffness = stiffness_of(view.patch.law), outward = reach_of(view.patch.law) + view.skin;
  for_each_eight(view, [&](const Pass& pass, int slave_side, int i) {
    const SlaveNodes nodes = load_slaves(pass, i);
    const Projection p = project(view.window, nodes.x, nodes.y, outward);
    const auto add = [&](int lane, double times) {
      const double k = 0.5 * times * nodes.tributary_length[lane] * stiffness;
      entries[pass.slave_force + i + lane] += factor[slave_side] * k;
      return factor[1 - slave_side] * k;
    };
    for (int lane = 0; lane < std::min(lane_count, pass.nodes.count - i); ++lane)
      if (pass.corners) {
        const Footholds footholds = possible_footholds(pass, view.window, p, lane, i, outward);
        if (footholds.shares.empty()) continue;
        const double k = add(lane, footholds.factor);
        for (const auto& [row, share] : footholds.shares) entries[pass.master_force + row] += share * k;
      } else if (p.hit[lane]) {
        const double k = add(lane, 1);
        const int at = pass.master_force + static_cast<int>(p.row[lane]);
        entries[at] += (1 - p.xi[lane]) * k;
        entries[at + 1] += p.xi[lane] * k;
      }
  });
}

}  // namespace pliant
