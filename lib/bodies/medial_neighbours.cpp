#include "bodies/medial_neighbours.hpp"

#include <algorithm>
#include <numeric>

namespace pliant {
namespace {

constexpr int samples = 64;  ///< along a segment

struct OutlineSegment {
  Vec2 start, tangent, middle;
  double length;
  Vec2 outward() const { return {tangent.y(), -tangent.x()}; }
  double distance(const Vec2& point) const {
    const double along = std::clamp((point - start).dot(tangent), 0.0, length);
    return (point - start - along * tangent).norm();
  }
};

class Neighbourhood {
 public:
  Neighbourhood(const OutlineShape& shape, double depth) : shape_(shape), depth_(depth) {
    for (int i = 0; i < shape.count; ++i) segments_.push_back(segment(i));
    by_x_.resize(segments_.size());
    std::iota(by_x_.begin(), by_x_.end(), 0);
    std::ranges::sort(by_x_, {}, [&](int i) { return segments_[i].middle.x(); });
  }

  /// Medial neighbours of a segment: offsets of their numbers from its own, ascending.
  std::vector<int> of_segment(int i) const {
    return nearer(points_below(i), i, [&](int offset) { return is_near(offset, -1, 1); });
  }
  std::array<bool, 2> has_shorter_next(int i) const {
    return {is_shorter(segment(i - 1), segment(i)), is_shorter(segment(i + 1), segment(i))};
  }
  /// Medial neighbours of a node: offsets from its number.
  std::vector<int> of_node(int i) const {
    return nearer(points_below_node(i), i, [&](int offset) { return is_near(offset, -1, 0); });
  }

 private:
  OutlineSegment segment(int i) const {
    const int n = shape_.count, turn = turn_of(i, n), next_turn = turn_of(i + 1, n);
    const Vec2 from = shape_.points[i - turn * n] + Vec2(turn * shape_.turn_shift, 0),
               to = shape_.points[i + 1 - next_turn * n] + Vec2(next_turn * shape_.turn_shift, 0);
    return {from, (to - from).normalized(), 0.5 * (from + to), (to - from).norm()};
  }
  /// Whether the adjacent segment is shorter by a sample or more. A bisector applies over the length of the other
  /// segment: there the projections onto both are equally far from the node.
  static bool is_shorter(const OutlineSegment& next, const OutlineSegment& s) {
    return next.length < (1 - 1.0 / samples) * s.length;
  }
  /// Point inside, and its depth below the place from which it was put.
  struct Inside {
    Vec2 point;
    double depth;
  };

  template <class IsOwn>
  std::vector<int> nearer(const std::vector<Inside>& points, int i, IsOwn&& is_own) const {
    std::vector<int> result;
    for (const int turn : {-1, 0, 1}) {
      if (turn != 0 && shape_.turn_shift == 0) continue;
      const Vec2 shift(turn * shape_.turn_shift, 0);
      for_each_near(segments_[i].middle - shift, [&](int k) {
        const int offset = k + turn * shape_.count - i;
        if (!is_own(offset) && comes_nearer(points, k, shift)) result.push_back(offset);
      });
    }
    std::ranges::sort(result);
    return result;
  }
  /// Whether an offset is in [first, last], cyclically on a closed outline.
  bool is_near(int offset, int first, int last) const {
    if (shape_.turn_shift != 0) return offset >= first && offset <= last;
    const int n = shape_.count;
    return ((offset - first) % n + n) % n <= last - first;
  }

  /// Deepest points that project on a segment that are nearer to it than to its neighbours. The depth of such a point
  /// less its distance to another segment increases inward, because that distance changes by no more than the path: so
  /// the deepest points suffice.
  std::vector<Inside> points_below(int i) const {
    std::vector<Inside> points;
    const OutlineSegment before = segment(i - 1), s = segment(i), after = segment(i + 1);
    const auto limit = [&](const Vec2& in, const Vec2& out, const Vec2& own) {
      return cross(in, out) > 0 ? Vec2(in + out) : own;
    };
    const Vec2 at_start = limit(before.tangent, s.tangent, s.tangent),
               at_end = limit(s.tangent, after.tangent, s.tangent);
    for (int u = 0; u <= samples; ++u) {
      const Vec2 foot = s.start + (s.length * u / samples) * s.tangent;
      double depth = depth_;
      const auto stop_at = [&](double at_foot, double inward) {
        if (inward < 0) depth = std::min(depth, std::max(0.0, at_foot) / -inward);
      };
      const double from_start = s.length * u / samples, to_end = s.length - from_start;
      if (!is_shorter(before, s) || from_start <= before.length)
        stop_at((foot - s.start).dot(at_start), -s.outward().dot(at_start));
      if (!is_shorter(after, s) || to_end <= after.length)
        stop_at((after.start - foot).dot(at_end), s.outward().dot(at_end));
      points.push_back({foot - depth * s.outward(), depth});
    }
    return points;
  }
  /// Points below a node, between the normals of both segments.
  std::vector<Inside> points_below_node(int i) const {
    std::vector<Inside> points;
    const Vec2 before = segment(i - 1).outward(), after = segment(i).outward();
    for (int u = 0; u <= samples; ++u) {
      const Vec2 direction = (u * after + (samples - u) * before).normalized();
      points.push_back({segments_[i].start - depth_ * direction, depth_});
    }
    return points;
  }

  template <class Visit>
  void for_each_near(const Vec2& place, Visit&& visit) const {
    const double reach = 2 * depth_ + shape_.longest;
    const auto middle_of = [&](int i) { return segments_[i].middle.x(); };
    for (auto at = std::ranges::lower_bound(by_x_, place.x() - reach, {}, middle_of);
         at != by_x_.end() && middle_of(*at) <= place.x() + reach; ++at)
      if ((segments_[*at].middle - place).norm() <= reach) visit(*at);
  }

  bool comes_nearer(const std::vector<Inside>& points, int k, const Vec2& shift) const {
    const double between = 2 * shape_.longest / samples;  // possible change from one of the points to the next
    return std::ranges::any_of(
        points, [&](const Inside& at) { return segments_[k].distance(at.point - shift) < at.depth + between; });
  }

  const OutlineShape& shape_;
  double depth_;
  std::vector<OutlineSegment> segments_;
  std::vector<int> by_x_;
};

}  // namespace

void find_medial_neighbours(OutlineShape& shape, double depth) {
  const Neighbourhood neighbourhood(shape, depth);
  const auto collect = [&](MedialNeighbours& result, auto&& of) {
    result = {{0}, {}};
    for (int i = 0; i < shape.count; ++i) {
      const std::vector<int> found = of(i);
      result.offset.insert(result.offset.end(), found.begin(), found.end());
      result.start.push_back(static_cast<int>(result.offset.size()));
    }
  };
  for (int i = 0; i < shape.count; ++i) shape.shorter_next.push_back(neighbourhood.has_shorter_next(i));
  collect(shape.medial, [&](int i) { return neighbourhood.of_segment(i); });
  collect(shape.node_medial, [&](int i) { return neighbourhood.of_node(i); });
}

}  // namespace pliant
