#include "contact/segment_stiffness.hpp"

#include <algorithm>

#include "contact/segment_cuts.hpp"

namespace pliant {
namespace {

/// The part of each of eight segments that may come to project on any segment of a master.
struct Hull8 {
  Lanes low = broadcast(1), high{};
  void add(LaneBits hit, const Span8& part) {
    low = select(hit, min(low, part.low), low), high = select(hit, max(high, part.high), high);
  }
};

/// Part within reach of a master segment. Before the next search outlines move relative to each other by the skin.
Span8 within_reach(const SlaveSegments& slaves, const MasterSegment& m, double reach, double depth, double skin) {
  const Lanes x0 = slaves.x0 - m.x, y0 = slaves.y0 - m.y, x1 = slaves.x1 - m.x, y1 = slaves.y1 - m.y;
  const Lanes height0 = x0 * m.tangent_y - y0 * m.tangent_x, height1 = x1 * m.tangent_y - y1 * m.tangent_x;
  const Lanes along0 = x0 * m.tangent_x + y0 * m.tangent_y, along1 = x1 * m.tangent_x + y1 * m.tangent_y;
  Span8 part;
  part.keep({along0 + skin, along1 + skin});
  part.keep({(m.length + skin) - along0, (m.length + skin) - along1});
  part.keep({(reach + skin) - height0, (reach + skin) - height1});
  part.keep({height0 + (depth + skin), height1 + (depth + skin)});
  return part;
}

void add_pass(const PairView& view, const HalfPass& pass, int slave_side, const double (&factor)[2],
              LinedNumbers& entries) {
  const MasterWindow& window = view.window;
  const double stiffness = 0.5 * stiffness_of(view.contact_pair.law), reach = reach_of(view.contact_pair.law),
               skin = view.skin;
  thread_local SlaveArc arc;
  arc.fill(pass);
  for (int i = 0; i < pass.segments; i += lane_count) {
    const LaneBits valid = first_lanes(pass.segments - i);
    const double *x = arc.x.data() + i, *y = arc.y.data() + i;
    const SlaveSegments slaves{load(x), load(y), load(x + 1), load(y + 1), load(&arc.lengths[i])};
    Hull8 hull;
    Lanes parts{};  // these may overlap, as a point may come to project on either of two segments
    const auto for_each_part = [&](auto&& visit) {
      for (int row = pass.rows.begin; row < pass.rows.end(); ++row) {
        const MasterSegment m = window[row];
        const Span8 part = within_reach(slaves, m, reach, window.depth(), skin);
        const LaneBits hit = valid & (part.low < part.high);
        if (any(hit)) visit(row, m, hit, part);
      }
    };
    for_each_part([&](int, const MasterSegment&, LaneBits hit, const Span8& part) {
      hull.add(hit, part);
      parts += select(hit, part.high - part.low, Lanes{});
    });
    const Lanes once = (hull.high - hull.low) / select(parts > 0.0, parts, broadcast(1));
    for_each_part([&](int row, const MasterSegment& m, LaneBits hit, const Span8& part) {
      const Lanes share = max(once, broadcast(m.length / (m.length + 2 * skin)));
      const double length = sum(select(hit, (part.high - part.low) * share * slaves.length, Lanes{}));
      const double of_node = 0.5 * factor[1 - slave_side] * stiffness * length;
      for (const int node : {row, row + 1}) entries[pass.master_force + node] += of_node;
    });
    const LaneBits hit = hull.low < hull.high;
    const Lanes all = select(hit, (factor[slave_side] * stiffness) * (hull.high - hull.low) * slaves.length, Lanes{});
    const Lanes middle = 0.5 * (hull.low + hull.high);
    for (int lane = 0; lane < std::min(lane_count, pass.segments - i); ++lane) {
      entries[pass.slave_force + i + lane] += all[lane] * (1 - middle[lane]);
      entries[pass.slave_force + i + lane + 1] += all[lane] * middle[lane];
    }
  }
}

}  // namespace

void add_integrated_stiffness(const PairView& view, const double (&factor)[2], LinedNumbers& entries) {
  for_each_half_pass(view, runs_in_table(view.contact_pair),
                     [&](const HalfPass& pass, int slave_side) { add_pass(view, pass, slave_side, factor, entries); });
}

}  // namespace pliant
