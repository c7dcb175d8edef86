#include "reference/discretisation/body_distances.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/polygon.hpp"

namespace pliant::reference {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Points that leave the outline by less count as inside: the path around the corner there is longer by its square.
constexpr double allowance = 1e-9;

/// Adds the shares of a segment at which it may pass the outline: crossings with an edge, and its start if that is
/// near.
void add_passages(std::vector<double>& shares, const Vec2& from, const Vec2& to, const Vec2& a, const Vec2& b) {
  const Vec2 way = to - from, edge = b - a;
  if (square_distance_to_edge(from, to, a) < allowance * allowance)
    shares.push_back((a - from).dot(way) / way.squaredNorm());
  const double determinant = pliant::cross(way, edge);
  if (std::abs(determinant) <= allowance * way.norm() * edge.norm()) return;
  const double along_edge = pliant::cross(a - from, way) / determinant;
  if (along_edge >= 0 && along_edge <= 1) shares.push_back(pliant::cross(a - from, edge) / determinant);
}

}  // namespace

BodyDistances::BodyDistances(Points outline) : outline_(std::move(outline)) {
  const std::size_t n = outline_.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 before = outline_[k] - outline_[(k + n - 1) % n], after = outline_[(k + 1) % n] - outline_[k];
    if (pliant::cross(before, after) < -allowance * before.norm() * after.norm()) corners_.push_back(outline_[k]);
  }
  const std::size_t count = corners_.size();
  between_.assign(count, std::vector<double>(count, infinity));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j)
      if (i == j || sees(corners_[i], corners_[j])) between_[i][j] = (corners_[i] - corners_[j]).norm();
  for (std::size_t via = 0; via < count; ++via)  // Floyd and Warshall
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j)
        between_[i][j] = std::min(between_[i][j], between_[i][via] + between_[via][j]);
}

bool BodyDistances::holds(const Vec2& x) const {
  return is_inside(outline_, x) || distance_to_outline(outline_, x) < allowance;
}

bool BodyDistances::sees(const Vec2& from, const Vec2& to) const {
  const double length = (to - from).norm();
  if (length < allowance) return true;
  std::vector<double> shares{0, 1};
  for (std::size_t k = 0; k < outline_.size(); ++k)
    add_passages(shares, from, to, outline_[k], outline_[(k + 1) % outline_.size()]);
  std::erase_if(shares, [](double share) { return share < 0 || share > 1; });
  std::sort(shares.begin(), shares.end());
  for (std::size_t piece = 1; piece < shares.size(); ++piece) {
    if ((shares[piece] - shares[piece - 1]) * length < allowance) continue;
    if (!holds(from + 0.5 * (shares[piece] + shares[piece - 1]) * (to - from))) return false;
  }
  return true;
}

Leg BodyDistances::first_leg(const Vec2& from, const Vec2& to, double limit) const {
  if (corners_.empty() || (to - from).norm() > limit) return {to, corners_.empty() ? 0 : infinity};
  if (sees(from, to)) return {to, 0};
  Leg best{to, infinity};
  double shortest = limit;
  for (std::size_t last = 0; last < corners_.size(); ++last) {
    const double end = (to - corners_[last]).norm();
    if (end > shortest || !sees(corners_[last], to)) continue;
    for (std::size_t first = 0; first < corners_.size(); ++first) {
      const Leg leg{corners_[first], between_[first][last] + end};
      if (leg.length_from(from) > shortest || !sees(from, corners_[first])) continue;
      best = leg, shortest = leg.length_from(from);
    }
  }
  return best;
}

}  // namespace pliant::reference
