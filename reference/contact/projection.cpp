#include "reference/contact/projection.hpp"

#include <cmath>

namespace pliant::reference {
namespace {

bool wedge_holds(const PresentOutline& master, int segment, const Vec2& point) {
  const Vec2 before = master.tangent(segment - 1), t = master.tangent(segment), after = master.tangent(segment + 1);
  return (point - master.node(segment)).dot(before + t) >= 0 && (point - master.node(segment + 1)).dot(t + after) < 0;
}

double height_over(const PresentOutline& master, int segment, const Vec2& point) {
  const Vec2 t = master.tangent(segment);
  return (point - master.node(segment)).dot(Vec2(t.y(), -t.x()));
}

}  // namespace

std::optional<Nearest> nearest_segment(const PresentOutline& master, int first, int count, const Vec2& point) {
  std::optional<Nearest> nearest;
  for (int i = first; i < first + count; ++i) {
    if (!wedge_holds(master, i, point)) continue;
    const double height = height_over(master, i, point);
    if (!nearest || std::abs(height) < std::abs(nearest->height)) nearest = Nearest{i, height};
  }
  return nearest;
}

Projection project(const Vec2& point, const Vec2& first, const Vec2& second) {
  const JetVector x = JetVector::point(point, 0), a = JetVector::point(first, 1), b = JetVector::point(second, 2);
  const JetVector t = unit(b - a), n = {t.y, -t.x};
  Projection result;
  result.length = sqrt(dot(b - a, b - a));
  result.gap = result.height = dot(x - a, n);
  result.xi = dot(x - a, t) / result.length;
  result.beyond = result.xi.value < 0 || result.xi.value > 1;
  if (!result.beyond) return result;
  result.xi = result.xi.value < 0 ? 0 : 1;
  const JetVector from_end = result.xi.value == 0 ? x - a : x - b;
  const Jet<6> distance = sqrt(dot(from_end, from_end));
  result.gap = result.height.value < 0 ? -distance : distance;
  result.angle = atan(dot(from_end, t) / dot(from_end, n));
  return result;
}

Jet<6>::Gradient Projection::rate() const { return beyond ? gap.value * angle.gradient : length.value * xi.gradient; }

Jet<6>::Hessian Projection::rate_derivative() const {
  const Jet<6>&factor = beyond ? gap : length, &place = beyond ? angle : xi;
  return place.gradient * factor.gradient.transpose() + factor.value * place.hessian;
}

}  // namespace pliant::reference
