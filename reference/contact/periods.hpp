#pragma once

#include <compare>
#include <vector>

#include <Eigen/Core>

#include "core/vec2.hpp"
#include "scene/scene.hpp"

namespace pliant::reference {

/// Numbers of periods from a body to one of its images; along x alone with one period.
struct Image {
  int x = 0, y = 0;
  auto operator<=>(const Image&) const = default;
};

/// Vectors of the periods of a domain at one time: none, (period, 0), or those of a deformed cell (docs/method.md 10).
class Periods {
 public:
  /// Those of a scene at a time, s. Throws InputError for a cell under a given stress.
  explicit Periods(const Scene& scene, double time = 0);

  /// From a body to its image, m.
  Vec2 shift(const Image& image) const { return vectors_ * Vec2(image.x, image.y); }
  /// All images with a shift between two corners, m, whatever the tilt of the cell: in ascending order.
  std::vector<Image> between(const Vec2& low, const Vec2& high) const;
  /// [2 x 2] vectors as columns, m; 0 for those that the domain does not have.
  const Eigen::Matrix2d& vectors() const { return vectors_; }
  /// Of a cell, m2.
  double area() const;

 private:
  int count_ = 0;  ///< of the periods
  Eigen::Matrix2d vectors_ = Eigen::Matrix2d::Zero();
};

}  // namespace pliant::reference
