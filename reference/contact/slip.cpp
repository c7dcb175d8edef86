#include "reference/contact/slip.hpp"

#include <algorithm>
#include <cmath>

namespace pliant::reference {
namespace {

/// Sums the path length from one segment to another, forward. Lengths and distances from the master are means of those
/// at the last accepted state and of the present ones.
class Way {
 public:
  Way(const PresentOutline& master, const PresentOutline& past, int segment)
      : master_(master), past_(past), segment_(segment) {}

  void add(const Jet<6>& part) { motion_.by_element += part; }

  /// Adds a share of a segment.
  void add_segment(int i, double share) {
    const Vec2 by = share / 2 * master_.tangent(i);
    add(share / 2 * (master_.length(i) + past_.length(i)));
    depends(i, -by);
    depends(i + 1, by);
  }

  /// Adds a corner by the rotation of the tangent: on its open side the path goes around it at the distance of the gap;
  /// on the other side the ends of both faces are cut off.
  void add_corner(int i, const Jet<6>& height, const Jet<6>& gap) {
    const JetVector before = JetVector::point(master_.node(i - 1), 0), corner = JetVector::point(master_.node(i), 1),
                    after = JetVector::point(master_.node(i + 1), 2);
    const JetVector in = unit(corner - before), out = unit(after - corner);
    const Vec2 past_in = past_.tangent(i - 1), past_out = past_.tangent(i);
    const double past_turn = std::atan2(past_in.x() * past_out.y() - past_in.y() * past_out.x(), past_in.dot(past_out));
    const Jet<6> angle = atan(cross(in, out) / (1 + dot(in, out))) + past_turn / 2;  // the mean of both ends
    const bool around = height.value * angle.value > 0;
    const Jet<6> turn = around ? angle : 2 * (sin(0.5 * angle) / cos(0.5 * angle)), &distance = around ? gap : height;
    add(distance * turn.value);
    for (int k = 0; k < 3; ++k) depends(i - 1 + k, distance.value * turn.gradient.segment<2>(2 * k));
  }

  /// Reverses the direction of the path.
  void reverse() {
    motion_.by_element = -motion_.by_element;
    for (auto& [node, derivative] : motion_.others) derivative = -derivative;
  }

  const MotionAlong& motion() const { return motion_; }

 private:
  /// Derivatives by the present segment's own nodes go to the element.
  void depends(int node, const Vec2& derivative) {
    const int own = node == segment_ ? 1 : node == segment_ + 1 ? 2 : 0;
    if (own > 0)
      motion_.by_element.gradient.segment<2>(2 * own) += derivative;
    else
      motion_.others.emplace_back(node, derivative);
  }

  const PresentOutline &master_, &past_;
  int segment_;
  MotionAlong motion_;
};

/// The old segment, numbered so that the path to the present one is the short one.
int old_segment(const PresentOutline& master, int remembered, int segment) {
  if (!master.closed()) return remembered;
  const int turns = static_cast<int>(std::lround(static_cast<double>(segment - remembered) / master.count()));
  return remembered + turns * master.count();
}

/// Slip between the flanks of a fold: the displacement at a gap, along the mean of the tangents at its ends.
/// Derivatives by the old segment's nodes are omitted: a Newton step over a fold converges more slowly.
Jet<6> across_fold(const PresentOutline& master, const ContactMemory& memory, int old, int segment,
                   const Projection& now, const Jet<6>& gap) {
  const JetVector a = JetVector::point(master.node(segment), 1), b = JetVector::point(master.node(segment + 1), 2);
  const JetVector t = unit(b - a);
  const Jet<6> c = cos(now.angle), s = sin(now.angle), along = now.xi * now.length;
  const JetVector normal = {c * t.y + s * t.x, s * t.y - c * t.x};
  const Vec2 face = master.tangent(old), out(face.y(), -face.x());
  const Vec2 old_normal = std::cos(memory.angle) * out + std::sin(memory.angle) * face;
  const Vec2 foot = master.node(old) + memory.xi * master.length(old) * face;
  const JetVector moved = {a.x + along * t.x + gap * (normal.x - old_normal.x()) - foot.x(),
                           a.y + along * t.y + gap * (normal.y - old_normal.y()) - foot.y()};
  const JetVector tangent = {0.5 * (-normal.y - old_normal.y()), 0.5 * (normal.x + old_normal.x())};
  return dot(tangent, moved);
}

}  // namespace

MotionAlong motion_along(const PresentOutline& master, const PresentOutline& past, const ContactMemory& memory,
                         int segment, const Projection& now) {
  const int old = old_segment(master, memory.segment, segment);
  Way way(master, past, segment);
  const Jet<6> length = 0.5 * (now.length + past.length(segment)), gap = 0.5 * (now.gap + memory.gap),
               height = 0.5 * (now.height + memory.height);
  if (old == segment) {
    way.add(length * (now.xi - memory.xi) + gap * sin(now.angle - memory.angle));
    return way.motion();
  }
  if (master.tangent(old).dot(master.tangent(segment)) < -0.5) {  // turned by more than 120 degrees
    way.add(across_fold(master, memory, old, segment, now, gap));
    return way.motion();
  }
  const bool forward = old < segment;
  const int low = std::min(old, segment), high = std::max(old, segment);
  way.add_segment(old, forward ? 1 - memory.xi : memory.xi);
  for (int i = low + 1; i < high; ++i) way.add_segment(i, 1);
  for (int i = low + 1; i <= high; ++i) way.add_corner(i, height, gap);
  way.add(length * (forward ? now.xi : 1 - now.xi));
  if (!forward) way.reverse();
  way.add(gap * (now.angle - memory.angle));
  return way.motion();
}

}  // namespace pliant::reference
