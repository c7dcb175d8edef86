#include "geometry/outline_search.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/polygon.hpp"

namespace pliant {
namespace {

constexpr std::size_t edges_of_leaf = 4;
/// Rounding of a box's distance must not exclude an edge that is as near.
constexpr double margin = 1 - 1e-12;

double square_distance(const Vec2& low, const Vec2& high, const Vec2& x) {
  return (low - x).cwiseMax(x - high).cwiseMax(0).squaredNorm();
}

}  // namespace

OutlineSearch::OutlineSearch(const Points& polygon) : polygon_(polygon) {
  const std::size_t n = polygon.size();
  boxes_.resize(4 * n);
  bound(0, 0, n);
  bottom_ = boxes_[0].low.y();
  strips_.resize(n);
  strips_per_length_ = static_cast<double>(n) / (boxes_[0].high.y() - bottom_);
  for (std::size_t i = 0; i < n; ++i) {
    const auto [low, high] = std::minmax(polygon[i].y(), polygon[(i + 1) % n].y());
    for (int s = strip_of(low); s <= strip_of(high); ++s) strips_[s].push_back(static_cast<int>(i));
  }
}

int OutlineSearch::strip_of(double y) const {
  return std::clamp(static_cast<int>((y - bottom_) * strips_per_length_), 0, static_cast<int>(strips_.size()) - 1);
}

void OutlineSearch::bound(std::size_t box, std::size_t first, std::size_t last) {
  Vec2 low = polygon_[first], high = low;
  for (std::size_t i = first; i <= last; ++i) {
    const Vec2& p = polygon_[i % polygon_.size()];
    low = low.cwiseMin(p), high = high.cwiseMax(p);
  }
  boxes_[box] = {low, high};
  if (last - first <= edges_of_leaf) return;
  bound(2 * box + 1, first, (first + last) / 2);
  bound(2 * box + 2, (first + last) / 2, last);
}

bool OutlineSearch::is_inside(const Vec2& x) const {
  if (x.y() < bottom_ || x.y() > boxes_[0].high.y()) return false;
  bool inside = false;
  for (const int i : strips_[strip_of(x.y())])
    if (edge_is_crossed(polygon_[(i + 1) % polygon_.size()], polygon_[i], x)) inside = !inside;
  return inside;
}

void OutlineSearch::search(std::size_t box, std::size_t first, std::size_t last, const Vec2& x, double& least) const {
  if (last - first <= edges_of_leaf) {
    for (std::size_t i = first; i < last; ++i)
      least = std::min(least, square_distance_to_edge(polygon_[i], polygon_[(i + 1) % polygon_.size()], x));
    return;
  }
  const std::size_t middle = (first + last) / 2;
  const double a = margin * square_distance(boxes_[2 * box + 1].low, boxes_[2 * box + 1].high, x);
  const double b = margin * square_distance(boxes_[2 * box + 2].low, boxes_[2 * box + 2].high, x);
  const bool first_nearer = a <= b;
  if (first_nearer && a <= least) search(2 * box + 1, first, middle, x, least);
  if (b <= least) search(2 * box + 2, middle, last, x, least);
  if (!first_nearer && a <= least) search(2 * box + 1, first, middle, x, least);
}

double OutlineSearch::distance(const Vec2& x, double at_most) const {
  double least = std::min((x - polygon_[0]).squaredNorm(), at_most * at_most);
  search(0, 0, polygon_.size(), x, least);
  return std::sqrt(least);
}

}  // namespace pliant
