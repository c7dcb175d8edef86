#include "contact/segment_pass.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "contact/laws/response.hpp"
#include "contact/segment_sums.hpp"
#include "contact/slave_segments.hpp"

namespace pliant {
namespace {

template <class Law>
constexpr bool has_dashpot = requires { Law::has_damping; };

Ends of_segments(const double* of_nodes, int node) { return {load(of_nodes + node), load(of_nodes + node + 1)}; }

/// How far outlines have come in the step, or how fast they go.
struct Ways {
  const double *slave_x = nullptr, *slave_y = nullptr, *master_x = nullptr, *master_y = nullptr;
};

/// The two nodes of a row and something of both.
struct RowWays {
  Vec2 first, second;
};

RowWays of_row(const Ways& ways, const MasterWindow& window, int row) {
  const int number = window.number(row);
  return {{ways.master_x[number], ways.master_y[number]}, {ways.master_x[number + 1], ways.master_y[number + 1]}};
}

/// Of a point on eight slave segments against a master's: how far, or fast, it goes past that, along x and y.
struct PairLanes {
  Lanes x, y;
};

PairLanes past_row(const Ways& ways, const MasterWindow& window, const QuadraturePoint& p, int node) {
  const RowWays row = of_row(ways, window, p.row);
  const Lanes x = of_segments(ways.slave_x, node).at(p.s), y = of_segments(ways.slave_y, node).at(p.s);
  return {x - (1.0 - p.xi) * row.first.x() - p.xi * row.second.x(),
          y - (1.0 - p.xi) * row.first.y() - p.xi * row.second.y()};
}

/// A segment's direction and length.
struct Frame {
  Vec2 tangent;
  double length;
  Frame(const Vec2& from, const Vec2& to) {
    const Vec2 along = to - from;
    length = along.norm(), tangent = along / length;
  }
};

/// How far a point has moved along the master's outline in the step, m: beside a segment l d(xi), about a node g times
/// the turn of the normal against the segment.
Lanes motion_along(const Ways& ways, const MasterWindow& window, const SlaveSegments& slaves, const QuadraturePoint& p,
                   int node) {
  const MasterSegment first = window[p.row], second = window[p.row + 1];
  const RowWays row = of_row(ways, window, p.row);
  const Vec2 a(first.x, first.y), b(second.x, second.y);
  const Frame now(a, b), before(a - row.first, b - row.second);
  const bool at_end = p.of_node && p.xi[0] > 0;
  const Vec2 origin = at_end ? b : a, moved = at_end ? row.second : row.first;
  const Lanes x = Ends{slaves.x0, slaves.x1}.at(p.s) - origin.x(), y = Ends{slaves.y0, slaves.y1}.at(p.s) - origin.y();
  const Lanes old_x = x - (of_segments(ways.slave_x, node).at(p.s) - moved.x()),
              old_y = y - (of_segments(ways.slave_y, node).at(p.s) - moved.y());
  const auto along = [](const Frame& f, Lanes u, Lanes v) { return u * f.tangent.x() + v * f.tangent.y(); };
  const auto above = [](const Frame& f, Lanes u, Lanes v) { return u * f.tangent.y() - v * f.tangent.x(); };
  if (!p.of_node) return along(now, x, y) - (now.length / before.length) * along(before, old_x, old_y);
  // The direction of growing places, in the segment's frame.
  const Lanes cosine = p.normal_x * now.tangent.y() - p.normal_y * now.tangent.x(),
              sine = p.normal_x * now.tangent.x() + p.normal_y * now.tangent.y();
  return cosine * (along(now, x, y) - along(before, old_x, old_y)) -
         sine * (above(now, x, y) - above(before, old_x, old_y));
}

/// A point that shears, and where its slaves stand in the pass.
struct ShearPoint {
  int i;
  QuadraturePoint point;
};

/// What a pass needs besides the law.
struct SegmentPass {
  const Pass& pass;
  const MasterWindow& window;
  Ways moved, speeds;  ///< in the step, now; empty where nobody asks
  PatchForces& forces;
};

struct Totals {
  Lanes stored{}, dissipated{}, damping_power{}, deepest{}, squares{};
  int segments = 0;  ///< in touch
};

/// Forces on both nodes of eight slave segments, N/m, and their reaction at xi. The couple is that of shears at the
/// gap's distance.
void add_forces(const SegmentPass& at, int i, const QuadraturePoint& p, const Lanes (&x)[2], const Lanes (&y)[2],
                double couple) {
  PatchForces& forces = at.forces;
  const int slave = at.pass.slave_force + i, master = at.pass.master_force + p.row;
  for (int end = 0; end < 2; ++end) add(&forces.x[slave + end], x[end]), add(&forces.y[slave + end], y[end]);
  const Lanes of_both_x = x[0] + x[1], of_both_y = y[0] + y[1];
  const double all_x = sum(of_both_x), all_y = sum(of_both_y), far_x = sum(p.xi * of_both_x),
               far_y = sum(p.xi * of_both_y);
  const MasterSegment m = at.window[p.row];
  const double turn_x = couple * m.tangent_y, turn_y = -couple * m.tangent_x;
  forces.x[master] -= all_x - far_x + turn_x, forces.y[master] -= all_y - far_y + turn_y;
  forces.x[master + 1] -= far_x - turn_x, forces.y[master + 1] -= far_y - turn_y;
}

/// The dashpot's pressure, and what friction makes of it. Returns its power, W/m.
template <class Law>
Lanes add_damping(const Law& law, const SegmentPass& at, const QuadraturePoint& p, int node, Traction& traction) {
  const PairLanes speed = past_row(at.speeds, at.window, p, node);
  const Lanes rate = p.normal_x * speed.x + p.normal_y * speed.y;
  const Lanes damping = law.damping_pressure(traction.pressure, p.gap, rate, at.pass.damping, at.pass.elapsed);
  add_pressure(law, damping, traction);
  return select(p.hit & (p.gap < 0.0), -p.weight * damping * rate, Lanes{});
}

/// Slip of each node: a length of contact that comes is unstretched, and one that goes takes its energy along.
template <class Law>
void slide_nodes(const Law& law, const Pass& pass, const ContactHistory& from, ContactHistory& to, NodeSums& sums,
                 Totals& totals) {
  for (int i = 0; i < pass.nodes.count; i += lane_count) {
    const Lanes* before = from.at(pass.record + i);
    Lanes* after = to.at(pass.record + i);
    const LaneBits active = first_lanes(pass.nodes.count - i);
    const Lanes weight = select(active, load(&sums.weight[i]), Lanes{}), known = before[ContactHistory::weight],
                old_weight = select(active & (known == known), known, Lanes{}), old_slip = before[ContactHistory::slip];
    const LaneBits touching = weight > 0.0;
    const Lanes inverse = select(touching, 1.0 / select(touching, weight, broadcast(1)), Lanes{});
    const Lanes slip =
        select(weight > old_weight, old_slip * old_weight * inverse, select(touching, old_slip, Lanes{}));
    Contact c{};
    slide(law, Traction{Lanes{}, load(&sums.shear_limit[i]) * inverse, Lanes{}}, touching, slip,
          slip + load(&sums.motion[i]) * inverse, c);
    totals.dissipated +=
        0.5 * law.shear_stiffness * (old_weight * old_slip * old_slip - weight * slip * slip) + weight * c.slip_work;
    totals.stored += weight * c.energy;
    store(&sums.shear[i], select(touching, c.shear, Lanes{}));
    after[ContactHistory::weight] = weight;
    after[ContactHistory::slip] = select(touching, c.slip, Lanes{});
  }
}

/// The shears of nodes, by their hat functions, at all points.
void add_shears(const SegmentPass& at, const std::vector<ShearPoint>& points, const NodeSums& sums) {
  for (const auto& [i, p] : points) {
    const Lanes shear = p.weight * Ends{load(&sums.shear[i]), load(&sums.shear[i + 1])}.at(p.s);
    const double couple = sum(shear * p.gap) * at.window[p.row].inverse_length;
    const Lanes second = p.s * shear, first = shear - second;
    add_forces(at, i, p, {-first * p.normal_y, -second * p.normal_y}, {first * p.normal_x, second * p.normal_x},
               couple);
  }
}

Ways ways_of(const PatchView& view, const OutlineField& field, int slave_side) {
  const int slave = view.model.outline_offset[view.body(slave_side)],
            master = view.model.outline_offset[view.body(1 - slave_side)];
  return {&field.x[slave], &field.y[slave], &field.x[master], &field.y[master]};
}

template <class Law>
void integrate_pass(const Law& law, const SegmentPass& at, const ContactHistory& from, ContactHistory& to,
                    Totals& totals) {
  const Pass& pass = at.pass;
  thread_local NodeSums sums;
  thread_local std::vector<ShearPoint> points;
  if constexpr (Law::has_shear) sums.clear(pass.nodes.count), points.clear();
  const GapRanges ranges = gap_ranges(law, at.window.depth());
  const double inverse_longest = 1 / at.window.longest();
  for (int i = 0; i < pass.segments; i += lane_count) {
    const SlaveSegments slaves = load_segments(pass, i);
    const int node = slave_index(pass, i);
    LaneBits touching{};
    for_each_point(at.window, pass.rows, ranges, slaves, [&](const QuadraturePoint& p) {
      Traction traction = law(p.gap);
      if constexpr (has_dashpot<Law>) totals.damping_power += add_damping(law, at, p, node, traction);
      const Lanes& pressure = traction.pressure;
      add_forces(at, i, p, {pressure * p.force_x[0], pressure * p.force_x[1]},
                 {pressure * p.force_y[0], pressure * p.force_y[1]}, 0);
      totals.stored += p.energy_weight * traction.energy;
      totals.squares += p.energy_weight * pressure * pressure;
      totals.deepest = max(totals.deepest, inverse_longest * p.depth);
      touching |= p.hit;
      if constexpr (Law::has_shear) {
        add_to_nodes(sums.weight, i, p.s, p.weight);
        add_to_nodes(sums.shear_limit, i, p.s, p.weight * traction.shear_limit);
        if (at.moved.slave_x)
          add_to_nodes(sums.motion, i, p.s, p.weight * motion_along(at.moved, at.window, slaves, p, node));
        points.push_back({i, p});
      }
    });
    totals.segments += std::popcount(bits(touching));
  }
  if constexpr (Law::has_shear) {
    const bool whole = pass.segments == pass.nodes.count;
    if (whole) sums.close(pass.segments);
    slide_nodes(law, pass, from, to, sums, totals);
    if (whole) sums.shear[pass.segments] = sums.shear[0];
    add_shears(at, points, sums);
  }
}

}  // namespace

double integrated_length(const PatchView& view) {
  Lanes length{};
  for_each_pass(view, runs_in_table(view.patch), [&](const Pass& pass, int) {
    const GapRanges inside = gap_ranges(Frictionless{}, view.window.depth());
    for (int i = 0; i < pass.segments; i += lane_count)
      for_each_point(view.window, pass.rows, inside, load_segments(pass, i),
                     [&](const QuadraturePoint& p) { length += p.weight; });
  });
  return sum(length);
}

PatchTotals integrate_patch(const PatchView& view, const ForceRuns& runs, const ContactHistory& from,
                            ContactHistory& to, PatchForces& forces) {
  Totals totals;
  const auto both_passes = [&]<class Law>(const Law& law) {
    if constexpr (!remembers<Law>) {
      double damping = 0;
      if constexpr (has_dashpot<Law>)
        if (const double length = integrated_length(view); length > 0) damping = law.root_damping / std::sqrt(length);
      for_each_pass(view, runs, [&](Pass& pass, int slave_side) {
        pass.damping = damping, pass.elapsed = view.elapsed;
        SegmentPass at{pass, view.window, {}, {}, forces};
        if (view.moved) at.moved = ways_of(view, *view.moved, slave_side);
        if constexpr (has_dashpot<Law>) at.speeds = ways_of(view, view.outlines.velocity, slave_side);
        integrate_pass(law, at, from, to, totals);
      });
    }
  };
  std::visit(both_passes, view.patch.law);
  PatchTotals result{sum(totals.stored), sum(totals.dissipated), sum(totals.damping_power), largest(totals.deepest),
                     totals.segments};
  result.squares = sum(totals.squares) / normal_stiffness_of(view.patch.law);
  return result;
}

}  // namespace pliant
