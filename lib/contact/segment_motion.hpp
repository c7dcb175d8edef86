#pragma once

#include <array>
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

  void fill_displacements(const PairView& view, int slave_side) {
    const OutlineField &now = view.outlines.position, &before = *view.before;
    fill(
        view, slave_side, [&](int side) -> Vec2 { return view.image_of(now, side) - view.image_of(before, side); },
        [&](int i) { return load(&now.x[i]) - load(&before.x[i]); },
        [&](int i) { return load(&now.y[i]) - load(&before.y[i]); });
  }
  void fill_velocities(const PairView& view, int slave_side) {
    const OutlineField& velocity = view.outlines.velocity;
    fill(
        view, slave_side, [&](int side) { return view.image_of(velocity, side); },
        [&](int i) { return load(&velocity.x[i]); }, [&](int i) { return load(&velocity.y[i]); });
  }

 private:
  /// x(i), y(i): values of eight outline nodes from i on. of_image(side): those of the side's image less its body's.
  template <class OfImage, class X, class Y>
  void fill(const PairView& view, int slave_side, OfImage&& of_image, X&& x, Y&& y) {
    const auto fill_side = [&](int side, const Arc& arc, ArcField& to_x, ArcField& to_y) {
      const OutlineShape& outline = view.model.outline_of(view.body(side));
      const int offset = view.model.outline_offset[view.body(side)];
      const Vec2 shift = of_image(side);
      to_x.fill(arc, outline, [&](int node, int) { return x(offset + node) + shift.x(); });
      to_y.fill(arc, outline, [&](int node, int) { return y(offset + node) + shift.y(); });
    };
    const ContactPair& pair = view.contact_pair;
    fill_side(slave_side, {pair.nodes[slave_side].begin, pair.slave_segments[slave_side]}, slave_x, slave_y);
    fill_side(1 - slave_side, pair.window[1 - slave_side], master_x, master_y);
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

/// Displacements of points along the master's outline in the step, m. On a segment they are the mean of the lengths at
/// both ends of the step times d(xi), so that the work of the shear is accurate to second order. Around a node they are
/// the gap at the start times the rotation of the normal relative to the segment.
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
    if (at.of_nodes) {  // distances begin at the node, whose xi is 0 or 1
      const Lanes start = xi.at0 * (at.length - old_length);
      along_ = {at.along.at0 - along.at0 - start, at.along.at1 - along.at1 - start};
    } else {
      const Lanes now = 0.5 * (1.0 + old_length * at.inverse_length), then = 0.5 * (1.0 + at.length / old_length);
      along_ = {now * at.along.at0 - then * along.at0, now * at.along.at1 - then * along.at1};
    }
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
