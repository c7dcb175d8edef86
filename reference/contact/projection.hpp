#pragma once

#include <optional>

#include "reference/contact/contacts.hpp"
#include "reference/jet.hpp"

namespace pliant::reference {

/// Current outline. Nodes and segments are numbered on over all turns; segment i is from node i to node i + 1.
class PresentOutline {
 public:
  PresentOutline(const ContactOutline& outline, const Points& x) : outline_(outline), x_(x) {}

  int count() const { return outline_.count; }
  bool closed() const { return outline_.turn_shift == 0; }
  double turn_shift() const { return outline_.turn_shift; }
  int index(int node) const { return outline_.first + within(node); }  ///< in the list of all outline nodes
  Vec2 node(int i) const { return x_[index(i)] + Vec2(turn(i) * outline_.turn_shift, 0); }
  double length(int segment) const { return (node(segment + 1) - node(segment)).norm(); }
  Vec2 tangent(int segment) const { return (node(segment + 1) - node(segment)).normalized(); }

 private:
  int within(int i) const { return ((i % count()) + count()) % count(); }
  int turn(int i) const { return (i - within(i)) / count(); }

  const ContactOutline& outline_;
  const Points& x_;
};

/// Vector that depends on six coordinates.
struct JetVector {
  Jet<6> x, y;
  /// Point number 0, 1 or 2 of the three.
  static JetVector point(const Vec2& at, int number) { return {{at.x(), 2 * number}, {at.y(), 2 * number + 1}}; }
  friend JetVector operator-(const JetVector& a, const JetVector& b) { return {a.x - b.x, a.y - b.y}; }
};

inline Jet<6> dot(const JetVector& a, const JetVector& b) { return a.x * b.x + a.y * b.y; }
inline Jet<6> cross(const JetVector& a, const JetVector& b) { return a.x * b.y - a.y * b.x; }
inline JetVector unit(const JetVector& a) {
  const Jet<6> length = sqrt(dot(a, a));
  return {a.x / length, a.y / length};
}

/// Among the segments [first, first + count) whose Voronoi region between the bisectors contains a point, the one with
/// the least height. For points steeply beyond an end, and not higher than `outward`, it is the truly nearest one.
struct Nearest {
  int segment = 0;
  double height = 0;  ///< positive outside, m
};
std::optional<Nearest> nearest_segment(const PresentOutline& master, int first, int count, const Vec2& point,
                                       double outward);

/// Projection of a point onto a segment, by the coordinates of the point and of the segment's first and second node
/// (docs/method.md 4).
struct Projection {
  Jet<6> gap;     ///< m
  Jet<6> height;  ///< above the segment's line, m
  Jet<6> length;  ///< of the segment, m
  Jet<6> xi;      ///< in [0, 1]
  Jet<6> angle;   ///< beyond an end: from the segment's normal to the point's, towards growing xi; else 0
  bool beyond = false;
  /// Rates of motion along the outline by the coordinates, and their derivatives.
  Jet<6>::Gradient rate() const;
  Jet<6>::Hessian rate_derivative() const;
};
Projection project(const Vec2& point, const Vec2& first, const Vec2& second);

}  // namespace pliant::reference
