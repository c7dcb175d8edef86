#include "reference/contact/contact_samples.hpp"

#include <cmath>
#include <numbers>

namespace pliant::reference {
namespace {

/// Points in [0, 1] and weights of the Gauss-Legendre rule, by Newton's method on the Legendre polynomial.
std::vector<std::pair<double, double>> gauss_rule(int points) {
  std::vector<std::pair<double, double>> rule;
  for (int i = 0; i < points; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5)), slope = 1;
    for (int round = 0; round < 50; ++round) {
      double before = 1, value = x;
      for (int n = 2; n <= points; ++n) {
        const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
        before = value, value = next;
      }
      slope = points * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    rule.emplace_back((1 + x) / 2, 1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

class Sampler {
 public:
  Sampler(const Sampling& of, int segment)
      : of_(of),
        segment_(segment),
        stretch_{of.slave.node(segment) - of.shift, of.slave.node(segment + 1) - of.shift} {}

  ContactSamples sample() {
    const std::vector<Part> parts = nearest_parts(of_.master, of_.first, of_.count, stretch_, of_.levels, of_.reach);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const Part& part = parts[k];
      if (make(part.nearby, part.middle()).at.gap.value >= of_.reach) continue;
      if (part.nearby.at_node)
        add_fan(part, part.start, part.end);
      else
        add_points(part, part.start, part.end, 2);
      if (k > 0) add_limit(part, parts[k - 1], part.start, -1);
      if (k + 1 < parts.size()) add_limit(part, parts[k + 1], part.end, 1);
    }
    return std::move(result_);
  }

 private:
  ContactSample make(const Nearby& nearby, double s) const {
    const int j = nearby.segment;
    ContactSample sample;
    sample.node = {of_.slave.index(segment_), of_.slave.index(segment_ + 1), of_.master.index(j),
                   of_.master.index(j + 1)};
    sample.s = s;
    sample.nearby = nearby;
    sample.at = project(stretch_.at(s), of_.master.node(j), of_.master.node(j + 1));
    // The other side of the segment, if the outline turns at the node by more than a right angle.
    if (nearby.at_node && is_outside(of_.master, j, stretch_.at(s)) != (sample.at.gap.value > 0))
      sample.at.gap = -sample.at.gap;
    return sample;
  }

  void add_points(const Part& part, double start, double end, int number) {
    static const auto two = gauss_rule(2), ten = gauss_rule(10);
    for (const auto& [x, weight] : number == 2 ? two : ten) {
      ContactSample sample = make(part.nearby, start + x * (end - start));
      sample.weight = weight * (end - start);
      result_.points.push_back(std::move(sample));
    }
  }

  /// Distances to a node are roots. Pieces no longer than their distance from it have errors of 4.2^-20, as the root's
  /// branch points are on an ellipse of that size. Parts nearer than a billionth of the stretch are one piece.
  void add_fan(const Part& part, double start, double end) {
    const Vec2 node = of_.master.node(part.nearby.segment), way = stretch_.along();
    const double foot = std::clamp((node - stretch_.first).dot(way) / way.squaredNorm(), start, end);
    const double length = (end - start) * way.norm();
    if (length <= (stretch_.at(foot) - node).norm() || length < 1e-9 * way.norm())
      return add_points(part, start, end, 10);
    const double half = (start + end) / 2;
    add_fan(part, start, half);
    add_fan(part, half, end);
  }

  /// Adds the end of a part: where its gap equals that of the next part, or reaches a level, or on the normal at an end
  /// of a segment, beyond which shear and slip follow a node.
  void add_limit(const Part& part, const Part& next, double s, double sign) {
    const bool same = part.nearby == next.nearby;
    ContactSample limit = make(part.nearby, s);
    limit.weight = sign;
    std::vector<std::pair<int, Vec2>> by_master;  // derivatives of the function that is zero at the limit
    Vec2 by_point = limit.at.gap.gradient.head<2>();
    if (!same && meet(part.nearby, next.nearby)) {
      const auto [node, segment] = part.nearby.at_node ? std::pair(part.nearby.segment, next.nearby.segment)
                                                       : std::pair(next.nearby.segment, part.nearby.segment);
      const bool at_end = of_.master.index(segment) != of_.master.index(node);
      by_point = end_normal(segment, at_end, stretch_.at(s), by_master);
    } else {
      const ContactSample other = make(next.nearby, s);
      for (const int end : {0, 1}) {
        by_master.emplace_back(limit.node[2 + end], limit.at.gap.gradient.segment<2>(2 + 2 * end));
        if (!same) by_master.emplace_back(other.node[2 + end], -other.at.gap.gradient.segment<2>(2 + 2 * end));
      }
      if (!same) by_point -= other.at.gap.gradient.head<2>();
    }
    const double slope = by_point.dot(stretch_.along());
    if (!(std::abs(slope) > 1e-12 * stretch_.along().norm())) return;  // tangential, or on one line
    limit.moves = {{limit.node[0], -(1 - s) / slope * by_point}, {limit.node[1], -s / slope * by_point}};
    for (const auto& [node, by] : by_master) limit.moves.emplace_back(node, -by / slope);
    result_.limits.push_back(std::move(limit));
  }

  /// Whether one is a segment and the other one of its nodes.
  bool meet(const Nearby& one, const Nearby& other) const {
    if (one.at_node == other.at_node) return false;
    const Nearby &fan = one.at_node ? one : other, &beside = one.at_node ? other : one;
    const int node = of_.master.index(fan.segment);
    return of_.master.index(beside.segment) == node || of_.master.index(beside.segment + 1) == node;
  }

  /// Derivatives of a point's distance past the normal at an end of a segment, by the point and by both nodes.
  Vec2 end_normal(int segment, bool at_end, const Vec2& point, std::vector<std::pair<int, Vec2>>& by_master) const {
    const PresentOutline& master = of_.master;
    const Vec2 from = point - master.node(segment + at_end), t = master.tangent(segment);
    const Vec2 turning = (from - from.dot(t) * t) / master.length(segment);
    by_master = {{master.index(segment), -turning}, {master.index(segment + 1), turning}};
    by_master[at_end].second -= t;
    return t;
  }

  const Sampling& of_;
  int segment_;
  Stretch stretch_;
  ContactSamples result_;
};

}  // namespace

Eigen::Matrix<double, 6, 8> ContactSample::spread() const {
  Eigen::Matrix<double, 6, 8> by = Eigen::Matrix<double, 6, 8>::Zero();
  by.topLeftCorner<2, 2>() = (1 - s) * Eigen::Matrix2d::Identity();
  by.block<2, 2>(0, 2) = s * Eigen::Matrix2d::Identity();
  by.bottomRightCorner<4, 4>().setIdentity();
  return by;
}

ContactSamples sample_contact(const Sampling& of, int segment) { return Sampler(of, segment).sample(); }

}  // namespace pliant::reference
