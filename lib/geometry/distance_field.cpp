#include "geometry/distance_field.hpp"

#include <cmath>

#include "geometry/polygon.hpp"

namespace pliant {

DistanceField::DistanceField(const Points& polygon) {
  Vec2 low = polygon[0], high = polygon[0];
  for (const Vec2& p : polygon) low = low.cwiseMin(p), high = high.cwiseMax(p);
  spacing_ = (high - low).maxCoeff() / cells;
  constexpr int margin = 3;  // in cells: nodes that come near are still outside
  origin_ = low - Vec2(margin, margin) * spacing_;
  columns_ = static_cast<int>(std::ceil((high - low).x() / spacing_)) + 2 * margin + 1;
  rows_ = static_cast<int>(std::ceil((high - low).y() / spacing_)) + 2 * margin + 1;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const Vec2 x = origin_ + spacing_ * Vec2(column, row);
      const double distance = distance_to_outline(polygon, x);
      values_.push_back(is_inside(polygon, x) ? -distance : distance);
    }
}

DistanceField::Sample DistanceField::at(const Vec2& x) const {
  const Vec2 r = (x - origin_) / spacing_;
  const double px = std::clamp(r.x(), 0.0, columns_ - 1.0), py = std::clamp(r.y(), 0.0, rows_ - 1.0);
  const int column = std::min(static_cast<int>(px), columns_ - 2), row = std::min(static_cast<int>(py), rows_ - 2);
  const double beyond = (r - Vec2(px, py)).norm();
  const double u = px - column, v = py - row;
  const double a = value(column, row), b = value(column + 1, row);
  const double c = value(column, row + 1), d = value(column + 1, row + 1);
  Sample sample;
  sample.distance = (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d) + beyond * spacing_;
  sample.gradient = Vec2((1 - v) * (b - a) + v * (d - c), (1 - u) * (c - a) + u * (d - b)) / spacing_;
  return sample;
}

}  // namespace pliant
