#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "contact/faces.hpp"

namespace pliant {

/// A number that depends on the nodes of Facing.
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

/// One slave node beside one segment of the master, at a foot there. What is measured from the foot does not jump where
/// the foot goes from one segment to the next.
struct Beside {
  const SlaveNode& node;
  const MasterSegment segment;
  Vec2 t = tangent(segment), n = outward_of(t);
  double along = (node.at - start(segment)).dot(t), height = (node.at - start(segment)).dot(n);
  double clamped = std::clamp(along, 0.0, segment.length);
  Vec2 foot = start(segment) + clamped * t;

  static Facing::Node neighbour(int side) { return side == 0 ? Facing::before : Facing::after; }
  static Facing::Node corner(int way) { return way < 0 ? Facing::corner_back : Facing::corner_on; }

  /// Adds what a turn of the segment's tangent does to a number that changes by `rate` with it.
  void turn_tangent(double rate, Varying& v) const {
    v.gradient[Facing::segment_end] += rate / segment.length * n;
    v.gradient[Facing::segment_start] -= rate / segment.length * n;
  }
  /// Adds what a move of the foot does to a number whose gradient by the foot's place is g.
  void move_foot(const Vec2& g, Varying& v) const {
    if (along <= 0) {
      v.gradient[Facing::segment_start] += g;
    } else if (along >= segment.length) {
      v.gradient[Facing::segment_end] += g;
    } else {
      const double gt = g.dot(t);
      v.gradient[Facing::itself] += gt * t;
      v.gradient[Facing::segment_start] += g - gt * t;
      turn_tangent(along * g.dot(n) + height * gt, v);
    }
  }

  /// From the foot to the corner on a way, over the part in that direction of the segment to one of the node's
  /// neighbours; infinite where that leads away.
  Varying steps_to(const Vec2& place, int way, int side) const {
    const Vec2 chord = place - foot, edge = node.neighbour[side] - node.at;
    const double part = edge.dot(chord);
    if (chord.squaredNorm() == 0) return {};
    if (part <= 0) return {std::numeric_limits<double>::infinity()};
    Varying v{chord.squaredNorm() / part};
    const Vec2 by_chord = (2 * chord - v.value * edge) / part, by_edge = -v.value / part * chord;
    v.gradient[neighbour(side)] = by_edge;
    v.gradient[Facing::itself] = -by_edge;
    v.gradient[corner(way)] = by_chord;
    move_foot(-by_chord, v);
    return v;
  }
  /// From the foot to the corner on a way, m.
  Varying distance(const Vec2& place, int way) const {
    const Vec2 chord = place - foot;
    Varying v{chord.norm()};
    if (v.value == 0) return v;
    v.gradient[corner(way)] = chord / v.value;
    move_foot(-chord / v.value, v);
    return v;
  }
  /// Of the node below the face, m.
  Varying depth() const {
    const Vec2 from = node.at - foot;
    Varying v{from.norm()};
    if (v.value == 0) return v;
    v.gradient[Facing::itself] = from / v.value;
    move_foot(-from / v.value, v);
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
  /// Cosine between the normal of the node, by the line between its neighbours, turned round, and that of the face from
  /// the foot to the corner on a way.
  Varying opposition_towards(const Vec2& place, int way) const {
    const Vec2 chord = place - foot, span = node.neighbour[1] - node.neighbour[0];
    const double length = chord.norm(), width = span.norm();
    if (length == 0) return {};
    const Vec2 to = way / length * chord, u = span / width;
    Varying v{-u.dot(to)};
    const Vec2 by_span = (u.dot(to) * u - to) / width, by_chord = way / length * (u.dot(to) * to - u);
    v.gradient[Facing::after] = by_span;
    v.gradient[Facing::before] = -by_span;
    v.gradient[corner(way)] = by_chord;
    move_foot(-by_chord, v);
    return v;
  }
};

/// Direction of the master's outline at a node beside a row, by the bisectors' normals at its ends, which turns without
/// a jump where the node goes on to the next row: from the one to the other as the node goes through the row's wedge.
class OutlineDirection {
 public:
  OutlineDirection(const Beside& at, const MasterWindow& window, const Faces& faces, int row) : at_(at) {
    const Vec2 offset[2] = {at.node.at - start(at.segment), start(window[row + 1]) - at.node.at};
    const double length[2] = {window.length_before(row), window[row + 1].length};
    for (int end = 0; end < 2; ++end) {
      const MasterSegment s = window[row + end];
      const bool corner = faces.is_corner(row + end);
      const Vec2 normal = corner ? Vec2(2 * at.t) : Vec2(s.bisector_x, s.bisector_y);
      ends_[end] = {corner, normal, offset[end], normal - at.t, length[end]};
      way_[end] = std::max(0.0, normal.dot(offset[end]));
    }
    const double whole = way_[0] + way_[1];
    share_ = whole > 0 ? way_[0] / whole : 0.5;
    direction_ = (1 - share_) * ends_[0].normal + share_ * ends_[1].normal;
  }

  /// Cosine between the normal of the node's segment on a side, turned round, and that of this direction.
  Varying opposition(int side) const {
    const double length = direction_.norm();
    const Vec2 m = direction_ / length, &u = at_.node.direction[side];
    Varying v{-u.dot(m)};
    const Vec2 turn = -outward_of(u).dot(m) / at_.node.present[side] * outward_of(u);
    v.gradient[Beside::neighbour(side)] = side == 0 ? Vec2(-turn) : turn;
    v.gradient[Facing::itself] = side == 0 ? turn : Vec2(-turn);
    turn_direction(-(u + v.value * m) / length, v);
    return v;
  }

 private:
  struct End {
    bool corner;    ///< the face ends there, and the outline's direction is the segment's
    Vec2 normal;    ///< of the bisector: the sum of both segments' tangents
    Vec2 offset;    ///< from the row's start to the node, or from the node to the row's end, m
    Vec2 tangent;   ///< of the segment beyond
    double length;  ///< of the same, m
  };

  /// Adds what a change of the direction does to a number with this gradient by it.
  void turn_direction(const Vec2& gradient, Varying& v) const {
    const double whole = way_[0] + way_[1], across = gradient.dot(ends_[1].normal - ends_[0].normal);
    const double slope = way_[0] > 0 && way_[1] > 0 ? across / whole : 0;  // by the way from either end
    const double part[2] = {1 - share_, share_}, rate[2] = {slope * (1 - share_), -slope * share_};
    for (int end = 0; end < 2; ++end) {
      const Vec2 by_normal = part[end] * gradient + rate[end] * ends_[end].offset;
      const double sign = end == 0 ? 1 : -1;
      v.gradient[Facing::itself] += sign * rate[end] * ends_[end].normal;
      v.gradient[end == 0 ? Facing::segment_start : Facing::segment_end] -= sign * rate[end] * ends_[end].normal;
      at_.turn_tangent((ends_[end].corner ? 2 : 1) * by_normal.dot(at_.n), v);
      if (ends_[end].corner) continue;
      const Vec2 n = outward_of(ends_[end].tangent), turned = by_normal.dot(n) / ends_[end].length * n;
      v.gradient[end == 0 ? Facing::segment_start : Facing::segment_on] += turned;
      v.gradient[end == 0 ? Facing::segment_back : Facing::segment_end] -= turned;
    }
  }

  const Beside& at_;
  End ends_[2];    ///< of the row's start and of its end
  double way_[2];  ///< of the node from the bisectors, times their normals' lengths, m
  double share_;   ///< of the way through the wedge
  Vec2 direction_;
};

}  // namespace pliant
