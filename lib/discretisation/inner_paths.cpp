#include "discretisation/inner_paths.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "geometry/triangulate.hpp"

namespace pliant {
namespace {

/// Sine of an angle that counts as zero: rounding of the outline's nodes is some 1e-13 of its spacing.
constexpr double flat = 1e-9;
/// The same for directions within a path, with rounding alone.
constexpr double aligned = 1e-13;

/// cross(a, b) over both lengths: sine of the left turn from a to b; 0 if one has no length.
double turn(const Vec2& a, const Vec2& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 0 ? cross(a, b) / lengths : 0;
}

double turn_at(const Points& outline, std::size_t k) {
  const std::size_t n = outline.size();
  return turn(outline[k] - outline[(k + n - 1) % n], outline[(k + 1) % n] - outline[k]);
}

/// Depth of x in a triangle; negative outside.
double depth_in(const Triangle& t, const Points& corners, const Vec2& x) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec2 &a = corners[t[k]], edge = corners[t[(k + 1) % 3]] - a;
    least = std::min(least, cross(edge, x - a) / edge.norm());
  }
  return least;
}

}  // namespace

InnerPaths::InnerPaths(const Points& outline) : search_(outline) {
  bool concave = false;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const double angle = turn_at(outline, k);
    concave |= angle < -flat;
    if (std::abs(angle) > flat) corners_.push_back(outline[k]);
  }
  if (!concave) return;
  triangles_ = triangulate_inside(corners_, static_cast<int>(corners_.size()));
  hang_up();
}

void InnerPaths::hang_up() {
  // edge, in its triangle's direction, to triangle and edge
  std::map<std::pair<int, int>, std::pair<int, int>> adjacent;
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int k = 0; k < 3; ++k) adjacent[{triangles_[t][k], triangles_[t][(k + 1) % 3]}] = {static_cast<int>(t), k};
  parent_.assign(triangles_.size(), -1), edge_.assign(triangles_.size(), 0), depth_.assign(triangles_.size(), 0);
  parent_[0] = 0;
  std::vector<int> reached{0};
  for (std::size_t n = 0; n < reached.size(); ++n) {
    const int t = reached[n];
    for (int k = 0; k < 3; ++k) {
      const auto other = adjacent.find({triangles_[t][(k + 1) % 3], triangles_[t][k]});
      if (other == adjacent.end() || parent_[other->second.first] >= 0) continue;
      const auto [child, edge] = other->second;
      parent_[child] = t, edge_[child] = edge, depth_[child] = depth_[t] + 1;
      reached.push_back(child);
    }
  }
}

int InnerPaths::triangle_at(const Vec2& x) const {
  int best = 0;
  double deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < triangles_.size() && deepest < 0; ++t) {
    const double depth = depth_in(triangles_[t], corners_, x);
    if (depth > deepest) deepest = depth, best = static_cast<int>(t);
  }
  return best;
}

std::vector<InnerPaths::Portal> InnerPaths::portals(int first, int last) const {
  std::vector<Portal> up, down;
  while (first != last) {
    const bool climb = depth_[first] >= depth_[last];
    int& t = climb ? first : last;
    const Vec2 &begin = corners_[triangles_[t][edge_[t]]], &end = corners_[triangles_[t][(edge_[t] + 1) % 3]];
    climb ? up.push_back({end, begin}) : down.push_back({begin, end});
    t = parent_[t];
  }
  up.insert(up.end(), down.rbegin(), down.rend());
  return up;
}

// Funnel algorithm: from the apex one ray to the left and one to the right bound the directions through all portals so
// far. A portal's end narrows the funnel; one beyond the other ray makes that ray's end the next apex, where a new
// funnel begins.
Vec2 InnerPaths::way(const Vec2& from, int first, const Vec2& to, int last) const {
  std::vector<Portal> gates = portals(first, last);
  gates.push_back({to, to});
  Vec2 apex = from, left = from, right = from, direction(0, 0);
  std::size_t of_left = 0, of_right = 0;  // portals of these ends
  double length = 0;
  const auto go_to = [&](const Vec2& corner) {
    const Vec2 leg = corner - apex;
    if (length <= aligned) direction = leg;
    length += leg.norm();
    apex = left = right = corner;
  };
  for (std::size_t gate = 0; gate < gates.size(); ++gate) {
    const Vec2 &new_left = gates[gate].left, &new_right = gates[gate].right;
    if (right == apex || turn(right - apex, new_right - apex) >= 0) {
      if (right != apex && left != apex && turn(left - apex, new_right - apex) > aligned) {
        gate = of_right = of_left;
        go_to(left);
        continue;
      }
      right = new_right, of_right = gate;
    }
    if (left == apex || turn(left - apex, new_left - apex) <= 0) {
      if (right != apex && left != apex && turn(right - apex, new_left - apex) < -aligned) {
        gate = of_left = of_right;
        go_to(right);
        continue;
      }
      left = new_left, of_left = gate;
    }
  }
  if (length == 0) return to - from;
  go_to(to);
  return length / direction.norm() * direction;
}

}  // namespace pliant
