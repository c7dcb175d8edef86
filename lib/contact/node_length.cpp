#include <array>

#include "contact/faces.hpp"

namespace pliant {
namespace {

/// Where a segment no longer lies flat on a face at all: 37 degrees.
constexpr double oblique = 0.8;
/// Least part along the face, over its length, that a segment counts with.
constexpr double steepest = 0.25;
/// Difference of such cosines at which the lesser of a corner's two segments no longer counts: 35 degrees, as of the least corner that lies flat.
constexpr double lesser = 0.18;

/// A number that depends on the seven nodes.
struct Varying {
  double value = 0;
  std::array<Vec2, Facing::nodes> gradient = none;

  static inline const std::array<Vec2, Facing::nodes> none = [] {
    std::array<Vec2, Facing::nodes> zero;
    zero.fill(Vec2(0, 0));
    return zero;
  }();

  Varying& add(double factor, const Varying& other) {
    value += factor * other.value;
    for (int i = 0; i < Facing::nodes; ++i) gradient[i] += factor * other.gradient[i];
    return *this;
  }
};

/// One slave node beside one segment of the master.
struct Beside {
  const SlaveNode& node;
  const MasterSegment& segment;
  Vec2 t = tangent(segment), n = outward_of(t);

  /// Adds what a turn of the segment's tangent does to a number that changes by `rate` with it.
  void turn_tangent(double rate, Varying& v) const {
    v.gradient[Facing::segment_end] += rate / segment.length * n;
    v.gradient[Facing::segment_start] -= rate / segment.length * n;
  }
  static Facing::Node neighbour(int side) { return side == 0 ? Facing::before : Facing::after; }
  /// How far a node lies from the slave's along the segment, on a way, m. `of`: which of the seven it is.
  Varying reach(const Vec2& place, Facing::Node of, int way) const {
    const Vec2 edge = place - node.at;
    Varying v{way * edge.dot(t)};
    v.gradient[of] = way * t;
    v.gradient[Facing::itself] = -way * t;
    turn_tangent(way * edge.dot(n), v);
    return v;
  }
  Varying opposition(int side) const {
    Varying v{node.opposition(side, t)};
    const Vec2& u = node.direction[side];
    const Vec2 turn = -outward_of(u).dot(t) / node.present[side] * outward_of(u);
    v.gradient[neighbour(side)] = side == 0 ? Vec2(-turn) : turn;
    v.gradient[Facing::itself] = side == 0 ? turn : Vec2(-turn);
    turn_tangent(-u.dot(n), v);
    return v;
  }
};

/// 0 up to 0, 1 from 1 on, with slope 0 at both.
Varying smooth_step(Varying u) {
  if (u.value <= 0) return {0};
  if (u.value >= 1) return {1};
  const double slope = 6 * u.value * (1 - u.value), value = u.value * u.value * (3 - 2 * u.value);
  Varying v{value};
  for (int i = 0; i < Facing::nodes; ++i) v.gradient[i] = slope * u.gradient[i];
  return v;
}

Varying scaled(double factor, const Varying& of, double shift = 0) {
  Varying v{shift};
  return v.add(factor, of);
}

Varying product(const Varying& a, const Varying& b) {
  Varying v = scaled(b.value, a);
  for (int i = 0; i < Facing::nodes; ++i) v.gradient[i] += a.value * b.gradient[i];
  return v;
}

Varying quotient(const Varying& a, const Varying& b) {
  Varying v = scaled(1 / b.value, a);
  for (int i = 0; i < Facing::nodes; ++i) v.gradient[i] -= v.value / b.value * b.gradient[i];
  return v;
}

/// What the segment on one side of the node stands for: half of its length, but near the end of the master's face. With r the way to the corner over
/// the segment's own part along the face, the last node before the corner (r < 1) has 3/2 r - 1 of the segment more, and the one before that
/// (1 < r < 2) 1 - r/2. Both together stand for what of the face lies beyond them, and each length goes with the node's place without a jump, to
/// nothing at the corner, where other faces come near. Segments that do not lie flat on the face have no more than their half. A corner of the
/// slave keeps its own: nobody else could stand in for it.
Varying length_of_side(const Beside& at, const Faces& faces, int row, int side, NodeLength& whole) {
  const double length = at.node.length[side];
  if (at.node.corner) return {0.5 * length};
  const Vec2& neighbour = at.node.neighbour[side];
  const int way = (neighbour - at.node.at).dot(at.t) < 0 ? -1 : 1;
  const std::optional<FaceEnd> end = faces.end_of_face(at.node, row, way, 3 * at.node.present[side]);
  if (!end) return {0.5 * length};
  Varying reach = at.reach(neighbour, Beside::neighbour(side), way);
  if (const double least = steepest * at.node.present[side]; reach.value < least) reach = {least};
  const Varying r =
      quotient(at.reach(faces.corner_place(*end), way < 0 ? Facing::corner_back : Facing::corner_on, way), reach);
  if (r.value >= 2 || (r.value >= 1 && at.node.beside_corner[side])) return {0.5 * length};
  whole.varies = true;
  whole.corner_row[way < 0 ? 0 : 1] = end->corner;
  const Varying more = r.value < 1 ? scaled(1.5, r, -1) : scaled(-0.5, r, 1);
  if (more.value <= 0) return scaled(length, more, 0.5 * length);
  const Varying flat = smooth_step(scaled(1 / (square - oblique), at.opposition(side), -oblique / (square - oblique)));
  return scaled(length, product(flat, more), 0.5 * length);
}

/// The lesser opposing segment of a corner counts by this factor.
Varying factor_of_lesser(const Beside& at, int side, NodeLength& whole) {
  Varying behind;
  behind.add(1 / lesser, at.opposition(1 - side)).add(-1 / lesser, at.opposition(side));
  whole.varies |= behind.value > 0 && behind.value < 1;
  return scaled(-1, smooth_step(behind), 1);
}

}  // namespace

NodeLength node_length(const SlaveNode& node, const MasterWindow& window, const Faces& faces, int row) {
  const Beside at{node, window[row]};
  NodeLength whole;
  Varying total;
  for (int side = 0; side < 2; ++side) {
    const Varying length = length_of_side(at, faces, row, side, whole);
    total.add(1, node.corner ? product(factor_of_lesser(at, side, whole), length) : length);
  }
  if (total.value <= 0) total = {};  // beside a face shorter than the node's own segments
  whole.value = total.value;
  whole.gradient = total.gradient;
  return whole;
}

}  // namespace pliant
