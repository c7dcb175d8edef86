#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "geometry/polygon.hpp"
#include "support/contact_rig.hpp"
#include "support/oracle_laws.hpp"

/// Contact at nodes, as docs/method.md 4 has it, once more: scalars, all nodes against all segments, no candidates, no
/// windows. Deliberately slow.
namespace pliant::testing {

/// One slave node and the place on the master that it belongs to.
struct OraclePoint {
  int segment;  ///< of the master, counted on through its turns
  double height, gap, xi, length;
  Vec2 normal, segment_tangent;

  Vec2 tangent() const { return {-normal.y(), normal.x()}; }
  /// Turn from the segment's normal to the point's.
  double angle() const { return std::asin(std::clamp(segment_tangent.dot(normal), -1.0, 1.0)); }
};

class ContactOracle {
 public:
  struct Result {
    std::vector<Points> force;  ///< [bodies][nodes]
    double stored = 0, dissipated = 0;
    double deepest = 0;  ///< penetration, m
    int contacts = 0, outside_truth = 0;
  };

  ContactOracle(const ContactRig& rig, const ContactRule& rule) : rig_(rig), law_{rule} {}

  Result evaluate() {
    Result result;
    trial_.clear();
    const int bodies = static_cast<int>(rig_.model.bodies.size());
    for (int b = 0; b < bodies; ++b) result.force.emplace_back(rig_.count(b), Vec2(0, 0));
    for (int slave = 0; slave < bodies; ++slave)
      for (int master = 0; master < bodies; ++master)
        if (slave != master) pass(slave, master, result);
    return result;
  }
  void commit() { committed_ = trial_; }

 private:
  using Key = std::tuple<int, int, int, int>;  // slave, node, master, periods added to the slave
  struct Memory {
    int segment;
    double xi, angle, slip;
  };

  const OutlineShape& shape(int body) const { return rig_.model.outlines[rig_.model.bodies[body].outline]; }
  Vec2 node(int body, int k) const {
    const int n = rig_.count(body), turn = k >= 0 ? k / n : -((n - 1 - k) / n);
    return rig_.node(body, k - turn * n) + Vec2(shape(body).turn_shift * turn, 0);
  }
  double reference_length(int body, int k) const {
    const Points& points = shape(body).points;
    const int n = rig_.count(body), at = ((k % n) + n) % n;
    return (points[(at + 1) % n] + Vec2(at + 1 == n ? shape(body).turn_shift : 0, 0) - points[at]).norm();
  }
  /// Unit normal of the line that halves the angle at node k, along the direction of travel.
  bool is_past(int body, int k, const Vec2& p) const {
    const Vec2 x = node(body, k), before = (x - node(body, k - 1)).normalized(),
               after = (node(body, k + 1) - x).normalized();
    const Vec2 outward_sum(before.y() + after.y(), -before.x() - after.x());  // the bisector's direction
    return cross(outward_sum, p - x) >= 0;
  }

  /// Distance to a segment's nearest point; nothing when the bisectors exclude it. However deep: the engine's limit is
  /// none where it is kept.
  std::optional<OraclePoint> on_segment(int body, int k, const Vec2& p) const {
    if (!is_past(body, k, p) || is_past(body, k + 1, p)) return {};
    return beside(body, k, p);
  }

  OraclePoint beside(int body, int k, const Vec2& p) const {
    const Vec2 a = node(body, k), b = node(body, k + 1);
    const double length = (b - a).norm();
    const Vec2 t = (b - a) / length, n(t.y(), -t.x());
    const double height = (p - a).dot(n), along = (p - a).dot(t);
    OraclePoint point{k, height, height, along / length, length, n, t};
    if (along < 0 || along > length) {
      const Vec2 end = along < 0 ? a : b;
      point.xi = along < 0 ? 0 : 1;
      point.gap = std::copysign((p - end).norm(), height);
      point.normal = (p - end) / point.gap;
    }
    return point;
  }

  std::optional<OraclePoint> find(int master, const Vec2& p) const {
    std::optional<OraclePoint> best;
    const int n = rig_.count(master), turns = rig_.model.bodies[master].wall ? reach_of_images() : 0;
    for (int k = -turns * n; k < (turns + 1) * n; ++k)
      if (const auto point = on_segment(master, k, p); point && (!best || std::abs(point->gap) < std::abs(best->gap)))
        best = point;
    return best;
  }

  int reach_of_images() const {
    if (!rig_.model.scene.period) return 0;
    const auto [low, high] = std::minmax_element(rig_.outlines.position.x.begin(), rig_.outlines.position.x.end());
    return 1 + static_cast<int>((*high - *low) / *rig_.model.scene.period);
  }

  void pass(int slave, int master, Result& result) {
    const int images = rig_.model.bodies[master].wall ? 0 : reach_of_images();
    for (int image = -images; image <= images; ++image)
      for (int k = 0; k < rig_.count(slave); ++k) {
        const Vec2 p = node(slave, k) + Vec2(image * rig_.model.scene.period.value_or(0), 0);
        std::optional<OraclePoint> point = find(master, p);
        check_against_truth(master, p, point, result);
        if (point && point->height > reach() + skin()) point.reset();
        const auto memory = committed_.find({slave, k, master, image});
        respond(slave, k, master, image, point, memory == committed_.end() ? nullptr : &memory->second, result);
      }
  }

  double reach() const { return law_.reach(); }
  double skin() const { return law_.kt() > 0 ? rig_.contact.skin() : 0; }

  /// Inside a closed master the node must be found, with its true distance to the outline as the penetration.
  void check_against_truth(int master, const Vec2& p, const std::optional<OraclePoint>& point, Result& result) const {
    if (shape(master).turn_shift != 0) return;
    const Points outline = rig_.outline(master);
    const double distance = distance_to_outline(outline, p), gap = is_inside(outline, p) ? -distance : distance;
    const bool seen = point && point->gap < 0;
    if (seen != (gap < 0) || (seen && std::abs(point->gap - gap) > 1e-12)) ++result.outside_truth;
  }

  void respond(int slave, int k, int master, int image, const std::optional<OraclePoint>& point, const Memory* old,
               Result& result) {
    const Key key{slave, k, master, image};
    OracleLaw law = law_;
    law.h = std::min(shape(slave).spacing, shape(master).spacing);
    const double weight = weight_of(slave, k);
    const double start = old ? old->slip : 0;
    if (!point || point->gap >= law.reach()) {
      // The place is remembered before the touch, so that slip counts from the first step of it.
      if (point) remember(key, *point, 0);
      result.dissipated += weight * 0.5 * law.kt() * start * start;
      return;
    }
    count_contact(*point, result);
    const double tried = start + (old ? way(master, *old, *point) : 0);
    const double most = law.kt() > 0 ? law.shear_limit(point->gap) / law.kt() : 0,
                 slip = std::clamp(tried, -most, most);
    remember(key, *point, slip);
    result.stored += weight * (law.energy(point->gap) + 0.5 * law.kt() * slip * slip);
    result.dissipated += weight * 0.5 * law.kt() * (start + slip) * (tried - slip);
    share_force(slave, k, master, *point, weight * law.pressure(point->gap), -weight * law.kt() * slip, result);
  }

  /// In one of the two passes.
  double weight_of(int slave, int k) const {
    return 0.25 * (reference_length(slave, k - 1) + reference_length(slave, k));
  }
  void count_contact(const OraclePoint& point, Result& result) const {
    ++result.contacts;
    result.deepest = std::max(result.deepest, -point.gap);
  }
  void remember(const Key& key, const OraclePoint& point, double slip) {
    trial_[key] = {point.segment, point.xi, point.angle(), slip};
  }

  /// Way from an old place to a new one along the master, at the new gap: the faces in between, and the turns of the
  /// normal at the corners passed. A node under a convex corner, or over a re-entrant one, jumps from face to face.
  /// Between the flanks of a fold: the displacement along the mean of the tangents.
  double way(int master, const Memory& from, const OraclePoint& to) const {
    const int n = rig_.count(master);
    int steps = (((to.segment - from.segment) % n) + n) % n;
    if (2 * steps > n) steps -= n;
    if (steps == 0) return to.length * (to.xi - from.xi) + to.gap * std::sin(to.angle() - from.angle);
    double sum = to.gap * (to.angle() - from.angle);
    const int first = to.segment - steps;
    const Vec2 start = node(master, first), face = node(master, first + 1) - start;
    if (face.normalized().dot(to.segment_tangent) < -0.5) {
      const double direction = std::atan2(face.y(), face.x()) + from.angle;
      const Vec2 tangent(std::cos(direction), std::sin(direction)), normal(tangent.y(), -tangent.x());
      const Vec2 here = node(master, to.segment) + to.xi * to.length * to.segment_tangent + to.gap * to.normal;
      return (tangent + to.tangent()).dot(here - start - from.xi * face - to.gap * normal) / 2;
    }
    const auto length = [&](int k) { return (node(master, k + 1) - node(master, k)).norm(); };
    sum += steps > 0 ? (1 - from.xi) * length(first) + to.xi * to.length
                     : -(from.xi * length(first) + (1 - to.xi) * to.length);
    for (int k = std::min(first, to.segment) + 1; k < std::max(first, to.segment); ++k)
      sum += std::copysign(length(k), steps);
    for (int k = std::min(first, to.segment) + 1; k <= std::max(first, to.segment); ++k)
      sum += std::copysign(1.0, steps) * around(master, k, to);
    return sum;
  }
  double around(int master, int corner, const OraclePoint& at) const {
    const Vec2 before = node(master, corner) - node(master, corner - 1),
               after = node(master, corner + 1) - node(master, corner);
    const double turn = std::atan2(cross(before, after), before.dot(after));
    if (at.height * turn > 0) return at.gap * turn;
    return 2 * at.height * std::tan(turn / 2);
  }

  /// Force on the node; the reaction on the segment's two nodes has the same sum and moment, and splits the normal part
  /// by 1 - xi and xi.
  void share_force(int slave, int k, int master, const OraclePoint& point, double normal, double shear,
                   Result& result) const {
    const Vec2 f = normal * point.normal + shear * point.tangent();
    const double couple =
        shear * point.gap / point.length;  // moment of the shear about the foot, as a pair of forces a segment apart
    const Vec2 n(point.segment_tangent.y(), -point.segment_tangent.x());
    const int count = rig_.count(master);
    const auto at = [&](int i) { return ((i % count) + count) % count; };
    result.force[slave][k] += f;
    result.force[master][at(point.segment)] -= (1 - point.xi) * f + couple * n;
    result.force[master][at(point.segment + 1)] -= point.xi * f - couple * n;
  }

  const ContactRig& rig_;
  OracleLaw law_;
  std::map<Key, Memory> committed_, trial_;
};

}  // namespace pliant::testing
