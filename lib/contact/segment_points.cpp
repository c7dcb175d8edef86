#include <limits>
#include <vector>

#include "contact/segment_motion.hpp"
#include "contact/segment_pass.hpp"
#include "contact/segment_quadrature.hpp"

namespace pliant {
namespace {

/// Sums for contact points in outputs: integrals for each slave node, weighted by its hat function.
class NodeTractions {
 public:
  std::vector<double> weight, gap, normal_x, normal_y, force_x, force_y, shear;  ///< m, m2, m, N/m

  /// `shears`: shear tractions of nodes, Pa, with one more entry after the last.
  template <class Law>
  void find(const Law& law, const HalfPass& pass, const MasterWindow& window, const std::vector<double>& shears) {
    const auto all = {&weight, &gap, &normal_x, &normal_y, &force_x, &force_y, &shear};
    for (std::vector<double>* of : all) of->assign(static_cast<std::size_t>(pass.nodes.count) + 1, 0.0);
    struct Visitor {
      const Law& law;
      NodeTractions& of;
      const std::vector<double>& shears;
      const SegmentPairs* pairs = nullptr;
      void begin(const SegmentPairs& now, const Linear&) { pairs = &now; }
      void end() {}
      void on_segment(const SegmentPoint& p) {
        const Lanes x = pairs->tangent_y, y = -pairs->tangent_x, second = p.s * p.weight, first = p.weight - second;
        const Lanes pressure = law(p.gap).pressure;
        FanShape shape{p.hit, {p.weight, second, p.s * second}};
        for (int power = 0; power < 3; ++power)
          shape.normal_x[power] = x * shape.weight[power], shape.normal_y[power] = y * shape.weight[power];
        shape.gap = {p.weight * p.gap, second * p.gap};
        in_fan_of(shape);
        add_forces(p.hit, pressure * first * x, pressure * second * x, pressure * first * y, pressure * second * y);
      }
      void in_fan(const FanPoint& p) {
        const Lanes pressure = law(p.gap).pressure;
        add_forces(p.hit, pressure * p.force_x[0], pressure * p.force_x[1], pressure * p.force_y[0],
                   pressure * p.force_y[1]);
      }
      void in_fan_of(const FanShape& f) {
        const auto add = [&](std::vector<double>& sums, const Moments& of) { HatSums(of).add_to(sums, *pairs, f.hit); };
        add(of.weight, {f.weight[0], f.weight[1]}), add(of.gap, f.gap);
        add(of.normal_x, {f.normal_x[0], f.normal_x[1]}), add(of.normal_y, {f.normal_y[0], f.normal_y[1]});
        const Lanes shear = gather(shears.data(), pairs->slave),
                    change = gather(shears.data() + 1, pairs->slave) - shear;
        add(of.shear, {shear * f.weight[0] + change * f.weight[1], shear * f.weight[1] + change * f.weight[2]});
      }
      void add_forces(LaneBits hit, Lanes first_x, Lanes second_x, Lanes first_y, Lanes second_y) {
        HatSums(first_x, second_x).add_to(of.force_x, *pairs, hit);
        HatSums(first_y, second_y).add_to(of.force_y, *pairs, hit);
      }
    } visitor{law, *this, shears};
    thread_quadrature().run(pass, window, gap_ranges(law, window.depth()), visitor);
    if (pass.segments == pass.nodes.count)  // on a whole outline the last node is the first one
      for (std::vector<double>* of : all) of->front() += of->back();
  }
};

/// Shear tractions of the nodes of a half pass, and of the first one again after the last.
template <class Law>
std::vector<double> shears_of(const Law& law, const HalfPass& pass, const ContactHistory& history) {
  std::vector<double> shears(static_cast<std::size_t>(pass.nodes.count) + 1, 0.0);
  if constexpr (Law::has_shear)
    for (int i = 0; i <= pass.nodes.count; ++i)
      shears[static_cast<std::size_t>(i)] =
          -law.shear_stiffness * history.number(pass.record + i % pass.nodes.count, ContactHistory::slip);
  return shears;
}

void add_points(const PairView& view, const HalfPass& pass, int side, const NodeTractions& found,
                const ContactHistory& history, std::vector<ContactPoint>& points) {
  for (int i = 0; i < pass.nodes.count; ++i) {
    const double weight = found.weight[i];
    if (!(weight > 0)) continue;
    const Vec2 force(found.force_x[i], found.force_y[i]), mean(found.normal_x[i], found.normal_y[i]);
    // Normals differ at corners; the total force on a node has one direction.
    const Vec2 along = force.norm() > 0 ? force : mean;
    const Vec2 normal = along.norm() > 0 ? Vec2((along.dot(mean) < 0 ? -1 : 1) * along.normalized()) : Vec2(0, 0);
    const int node = slave_index(pass, i), turn = turn_of(pass.nodes.begin + i, pass.slave->count);
    ContactPoint point{view.body(side), view.body(1 - side), node, found.gap[i] / weight};
    point.slip = history.number(pass.record + i, ContactHistory::slip);
    point.pressure = force.dot(normal) / weight, point.shear = found.shear[i] / weight;
    point.length = 2 * weight;
    point.normal = normal, point.side = side;
    point.position = Vec2(pass.slave_x[node] + pass.slave_shift.x() + turn * pass.slave->turn_shift,
                          pass.slave_y[node] + pass.slave_shift.y());
    points.push_back(point);
  }
}

}  // namespace

std::vector<ContactPoint> inspect_integrated(const PairView& view, const ContactHistory& history) {
  std::vector<ContactPoint> points;
  NodeTractions found;
  const auto both_passes = [&]<class Law>(const Law& law) {
    for_each_half_pass(view, runs_in_table(view.contact_pair), [&](const HalfPass& pass, int side) {
      found.find(law, pass, view.window, shears_of(law, pass, history));
      add_points(view, pass, side, found, history, points);
    });
  };
  std::visit(both_passes, view.contact_pair.law);
  return points;
}

}  // namespace pliant
