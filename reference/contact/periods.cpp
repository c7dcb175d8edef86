#include "reference/contact/periods.hpp"

#include <cmath>

#include <Eigen/LU>

#include "core/errors.hpp"

namespace pliant::reference {

Periods::Periods(const Scene& scene, double time) {
  if (scene.period) count_ = 1, vectors_(0, 0) = *scene.period;
  if (!scene.cell) return;
  if (scene.cell->is_stress_controlled())
    throw InputError(
        "[domain.cell] stress_xx, stress_yy, stress_xy: the reference solver follows given gradients alone; give xx, "
        "yy, xy");
  count_ = 2;
  vectors_ = scene.cell->gradient_at(time) * scene.cell->periods.asDiagonal();
}

std::vector<Image> Periods::between(const Vec2& low, const Vec2& high) const {
  const auto holds = [&](const Vec2& shift) { return (shift - low).minCoeff() >= 0 && (high - shift).minCoeff() >= 0; };
  // In numbers of periods the box is a parallelogram: all images within its extent are tried.
  Vec2 first(0, 0), last(0, 0);
  if (count_ == 1) first.x() = low.x() / vectors_(0, 0), last.x() = high.x() / vectors_(0, 0);
  if (count_ == 2) {
    const Eigen::Matrix2d inverse = vectors_.inverse();
    first = last = inverse * low;
    for (const Vec2& corner : {Vec2(low.x(), high.y()), Vec2(high.x(), low.y()), high}) {
      const Vec2 numbers = inverse * corner;
      first = first.cwiseMin(numbers), last = last.cwiseMax(numbers);
    }
  }
  std::vector<Image> images;
  for (int x = static_cast<int>(std::ceil(first.x())); x <= static_cast<int>(std::floor(last.x())); ++x)
    for (int y = static_cast<int>(std::ceil(first.y())); y <= static_cast<int>(std::floor(last.y())); ++y)
      if (holds(shift({x, y}))) images.push_back({x, y});
  return images;
}

double Periods::area() const { return vectors_.determinant(); }

}  // namespace pliant::reference
