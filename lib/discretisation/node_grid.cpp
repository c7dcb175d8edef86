#include "discretisation/node_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pliant {

NodeGrid::NodeGrid(const Points& points, double cell) : points_(points), cell_(cell) {
  Vec2 high = low_ = points[0];
  for (const Vec2& p : points) low_ = low_.cwiseMin(p), high = high.cwiseMax(p);
  columns_ = static_cast<int>((high.x() - low_.x()) / cell) + 1;
  rows_ = static_cast<int>((high.y() - low_.y()) / cell) + 1;
  const auto cell_of = [&](const Vec2& p) {
    return static_cast<std::size_t>(row_of(p.y()) * columns_ + column_of(p.x()));
  };
  start_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const Vec2& p : points) ++start_[cell_of(p) + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  std::vector<int> next(start_.begin(), start_.end() - 1);
  entries_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) entries_[next[cell_of(points[i])]++] = static_cast<int>(i);
}

int NodeGrid::column_of(double x) const {
  return static_cast<int>(std::clamp((x - low_.x()) / cell_, 0.0, columns_ - 1.0));
}

int NodeGrid::row_of(double y) const { return static_cast<int>(std::clamp((y - low_.y()) / cell_, 0.0, rows_ - 1.0)); }

std::vector<int> NodeGrid::near(const Vec2& x, double radius) const {
  std::vector<int> result;
  const int left = column_of(x.x() - radius), right = column_of(x.x() + radius);
  for (int row = row_of(x.y() - radius); row <= row_of(x.y() + radius); ++row)
    result.insert(result.end(), entries_.begin() + start_[row * columns_ + left],
                  entries_.begin() + start_[row * columns_ + right + 1]);
  std::sort(result.begin(), result.end());
  return result;
}

double NodeGrid::square_distance_to_nearest(const Vec2& x, int number) const {
  std::vector<double> squared;
  for (double radius = 2 * cell_;; radius *= 2) {
    squared.clear();
    for (const int i : near(x, radius)) squared.push_back((points_[i] - x).squaredNorm());
    if (static_cast<int>(squared.size()) <= number) continue;
    std::nth_element(squared.begin(), squared.begin() + number, squared.end());
    if (squared[number] <= radius * radius) return squared[number];
  }
}

NodeGrid make_node_grid(const Points& points) {
  Vec2 low = points[0], high = low;
  for (const Vec2& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec2 extent = high - low;
  return {points, std::max(std::sqrt(extent.x() * extent.y() / static_cast<double>(points.size())),
                           extent.maxCoeff() / static_cast<double>(points.size()))};
}

}  // namespace pliant
