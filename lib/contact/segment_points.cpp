#include <limits>
#include <vector>

#include "contact/segment_pass.hpp"
#include "contact/segment_sums.hpp"
#include "contact/slave_segments.hpp"

namespace pliant {
namespace {

/// What points of contact in outputs are made of: of each slave node, times its hat function.
struct NodeTractions {
  NodeSums sums;
  std::vector<double> gap, normal_x, normal_y, force_x, force_y, shear;  ///< m2, m, N/m

  void clear(int nodes) {
    sums.clear(nodes);
    for (std::vector<double>* of : {&gap, &normal_x, &normal_y, &force_x, &force_y, &shear}) *of = sums.weight;
  }
  void close(int segments) {
    sums.close(segments);
    for (std::vector<double>* of : {&gap, &normal_x, &normal_y, &force_x, &force_y, &shear})
      (*of)[0] += (*of)[segments];
  }
};

template <class Law>
void find_tractions(const Law& law, const Pass& pass, const MasterWindow& window, const ContactHistory& history,
                    NodeTractions& found) {
  found.clear(pass.nodes.count);
  const bool whole = pass.segments == pass.nodes.count;
  for (int i = 0; i < pass.nodes.count; ++i)
    found.sums.shear[i] = -law.shear_stiffness * history.number(pass.record + i, ContactHistory::slip);
  if (whole) found.sums.shear[pass.segments] = found.sums.shear[0];
  for (int i = 0; i < pass.segments; i += lane_count)
    for_each_point(
        window, pass.rows, gap_ranges(law, window.depth()), load_segments(pass, i), [&](const QuadraturePoint& p) {
          const Lanes pressure = law(p.gap).pressure;
          add_to_nodes(found.sums.weight, i, p.s, p.weight);
          add_to_nodes(found.gap, i, p.s, p.weight * p.gap);
          add_to_nodes(found.normal_x, i, p.s, p.weight * p.normal_x);
          add_to_nodes(found.normal_y, i, p.s, p.weight * p.normal_y);
          for (int end = 0; end < 2; ++end) {
            add(&found.force_x[i + end], pressure * p.force_x[end]);
            add(&found.force_y[i + end], pressure * p.force_y[end]);
          }
          if constexpr (Law::has_shear)
            add_to_nodes(found.shear, i, p.s,
                         p.weight * Ends{load(&found.sums.shear[i]), load(&found.sums.shear[i + 1])}.at(p.s));
        });
  if (whole) found.close(pass.segments);
}

void add_points(const PatchView& view, const Pass& pass, int side, const NodeTractions& found,
                const ContactHistory& history, std::vector<ContactPoint>& points) {
  for (int i = 0; i < pass.nodes.count; ++i) {
    const double weight = found.sums.weight[i];
    if (!(weight > 0)) continue;
    const Vec2 force(found.force_x[i], found.force_y[i]), mean(found.normal_x[i], found.normal_y[i]);
    const Vec2 normal = mean.norm() > 0 ? Vec2(mean.normalized()) : Vec2(0, 0);
    const int node = slave_index(pass, i), turn = turn_of(pass.nodes.begin + i, pass.slave->count);
    ContactPoint point{view.body(side), view.body(1 - side), node, found.gap[i] / weight};
    point.slip = history.number(pass.record + i, ContactHistory::slip);
    point.pressure = force.dot(normal) / weight, point.shear = found.shear[i] / weight;
    point.damage = std::numeric_limits<double>::quiet_NaN();
    point.length = 2 * weight;
    point.normal = normal, point.side = side;
    point.position = Vec2(pass.slave_x[node] + pass.slave_shift + turn * pass.slave->turn_shift, pass.slave_y[node]);
    points.push_back(point);
  }
}

}  // namespace

std::vector<ContactPoint> inspect_integrated(const PatchView& view, const ContactHistory& history) {
  std::vector<ContactPoint> points;
  NodeTractions found;
  const auto both_passes = [&]<class Law>(const Law& law) {
    if constexpr (!remembers<Law>)
      for_each_pass(view, runs_in_table(view.patch), [&](const Pass& pass, int side) {
        find_tractions(law, pass, view.window, history, found);
        add_points(view, pass, side, found, history, points);
      });
  };
  std::visit(both_passes, view.patch.law);
  return points;
}

}  // namespace pliant
