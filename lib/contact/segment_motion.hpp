#pragma once

#include <cstddef>
#include <vector>

#include "contact/segment_cuts.hpp"

namespace pliant {

/// Integrals of a quantity times the hat functions of both nodes, over parts of eight slave segments.
struct HatSums {
  Lanes first, second;
  HatSums(Lanes first, Lanes second) : first(first), second(second) {}
  explicit HatSums(const Moments& of) : HatSums(of.plain - of.times_s, of.times_s) {}
  /// Adds them to the sums of the nodes of the pass.
  void add_to(std::vector<double>& of_nodes, const SegmentPairs& pairs, LaneBits hit) const {
    for_each_lane(hit, [&](int lane) {
      double* at = &of_nodes[static_cast<std::size_t>(pairs.slave[lane])];
      at[0] += first[lane], at[1] += second[lane];
    });
  }
};

/// Integrals over all parts of a half pass, by nodes.
struct NodeSums {
  std::vector<double> weight, shear_limit, motion;  ///< m, N/m, m2
  std::vector<double> shear;                        ///< Pa, the traction that results

  void clear(int nodes) {
    for (std::vector<double>* sums : {&weight, &shear_limit, &motion, &shear})
      sums->assign(static_cast<std::size_t>(padded(nodes) + 2 * lane_count), 0.0);
  }
  /// On a whole outline the last node is the first one, which gets the sums of both.
  void close(int segments) {
    for (std::vector<double>* sums : {&weight, &shear_limit, &motion}) (*sums)[0] += (*sums)[segments];
  }
};

/// Forces of eight pairs on both nodes of the slave's segment, N/m.
struct PairForces {
  Lanes x[2], y[2];
};

/// Displacements in the step, or velocities, of the nodes of a half pass.
struct PairMotion {
  ArcField slave_x, slave_y, master_x, master_y;

  void fill(const PairView& view, const OutlineField& field, int slave_side) {
    const int slave = view.body(slave_side), master = view.body(1 - slave_side);
    const OutlineShape &of_slave = view.model.outline_of(slave), &of_master = view.model.outline_of(master);
    const Arc segments{view.contact_pair.nodes[slave_side].begin, view.contact_pair.slave_segments[slave_side]},
        window = view.contact_pair.window[1 - slave_side];
    const Vec2 by_slave = view.image_of(field, slave_side), by_master = view.image_of(field, 1 - slave_side);
    slave_x.fill(&field.x[view.model.outline_offset[slave]], segments, of_slave, by_slave.x(), 0);
    slave_y.fill(&field.y[view.model.outline_offset[slave]], segments, of_slave, by_slave.y(), 0);
    master_x.fill(&field.x[view.model.outline_offset[master]], window, of_master, by_master.x(), 0);
    master_y.fill(&field.y[view.model.outline_offset[master]], window, of_master, by_master.y(), 0);
  }
};

/// Motion of the four nodes of eight pairs.
struct NodeMotions {
  Lanes slave_x0, slave_y0, slave_x1, slave_y1, first_x, first_y, second_x, second_y;
  NodeMotions() = default;
  NodeMotions(const SegmentPairs& at, const PairMotion& of)
      : slave_x0(gather(of.slave_x.data(), at.slave)),
        slave_y0(gather(of.slave_y.data(), at.slave)),
        slave_x1(gather(of.slave_x.data() + 1, at.slave)),
        slave_y1(gather(of.slave_y.data() + 1, at.slave)),
        first_x(gather(of.master_x.data(), at.row)),
        first_y(gather(of.master_y.data(), at.row)),
        second_x(gather(of.master_x.data() + 1, at.row)),
        second_y(gather(of.master_y.data() + 1, at.row)) {}
};

/// Displacements of points along the master's outline in the step, m: on a segment l d(xi), around a node g times
/// the rotation of the normal relative to the segment.
class TangentialMotion {
 public:
  TangentialMotion() = default;
  TangentialMotion(const SegmentPairs& at, const Linear& xi, const PairMotion& moved)
      : tangent_x_(at.tangent_x), tangent_y_(at.tangent_y) {
    const NodeMotions m(at, moved);
    const Lanes dx = at.tangent_x * at.length - (m.second_x - m.first_x),
                dy = at.tangent_y * at.length - (m.second_y - m.first_y), old_length = sqrt(dx * dx + dy * dy),
                tx = dx / old_length, ty = dy / old_length;
    // Vectors from the first node of the master's segment to the ends of the slave's, before the step.
    const auto place = [&](const Linear& now) -> std::array<Lanes, 4> {
      return {
          at.along.at0 * at.tangent_x + now.at0 * at.tangent_y, at.along.at0 * at.tangent_y - now.at0 * at.tangent_x,
          at.along.at1 * at.tangent_x + now.at1 * at.tangent_y, at.along.at1 * at.tangent_y - now.at1 * at.tangent_x};
    };
    auto [x0, y0, x1, y1] = place(at.height);
    x0 -= m.slave_x0 - m.first_x, y0 -= m.slave_y0 - m.first_y;
    x1 -= m.slave_x1 - m.first_x, y1 -= m.slave_y1 - m.first_y;
    const Linear along{x0 * tx + y0 * ty, x1 * tx + y1 * ty}, height{x0 * ty - y0 * tx, x1 * ty - y1 * tx};
    // In a vertex region distances begin at the node, whose xi is 0 or 1.
    const Lanes stretch = at.of_nodes ? broadcast(1) : at.length / old_length,
                start = at.of_nodes ? xi.at0 * (at.length - old_length) : Lanes{};
    along_ = {at.along.at0 - stretch * along.at0 - start, at.along.at1 - stretch * along.at1 - start};
    height_ = at.height - height;
  }

  Lanes on_segment(const SegmentPoint& p) const { return along_.at(p.s); }
  /// Integrals over a part of a vertex region.
  Moments in_fan(const FanShape& f) const {
    // Tangent in the direction of growing surface coordinates, in the segment's frame, times powers of s.
    Lanes cosine[3], sine[3];
    for (int power = 0; power < 3; ++power)
      cosine[power] = f.normal_x[power] * tangent_y_ - f.normal_y[power] * tangent_x_,
      sine[power] = f.normal_x[power] * tangent_x_ + f.normal_y[power] * tangent_y_;
    const Lanes along = along_.at1 - along_.at0, height = height_.at1 - height_.at0;
    const auto times = [&](int power) {
      return along_.at0 * cosine[power] + along * cosine[power + 1] - height_.at0 * sine[power] -
             height * sine[power + 1];
    };
    return {times(0), times(1)};
  }

 private:
  Linear along_, height_;  ///< their changes in the step
  Lanes tangent_x_, tangent_y_;
};

/// Velocity of points of the slave relative to those of the master, m/s.
class SpeedPast {
 public:
  SpeedPast() = default;
  SpeedPast(const SegmentPairs& at, const PairMotion& speeds) : of_(at, speeds) {}

  Lanes along(Lanes normal_x, Lanes normal_y, Lanes s, Lanes xi) const {
    const Lanes x = Linear{of_.slave_x0, of_.slave_x1}.at(s) - Linear{of_.first_x, of_.second_x}.at(xi),
                y = Linear{of_.slave_y0, of_.slave_y1}.at(s) - Linear{of_.first_y, of_.second_y}.at(xi);
    return normal_x * x + normal_y * y;
  }

 private:
  NodeMotions of_;
};

}  // namespace pliant
