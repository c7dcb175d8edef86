#include "reference/contact/projection.hpp"

#include <cmath>
#include <limits>

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

/// Segment with the nearest point, whatever its Voronoi region; of two that meet at the nearest point the one seen more
/// steeply.
Nearest truly_nearest(const PresentOutline& master, int first, int count, const Vec2& point) {
  Nearest nearest{first, 0};
  double least = std::numeric_limits<double>::infinity();
  for (int i = first; i < first + count; ++i) {
    const Vec2 a = master.node(i), b = master.node(i + 1);
    const double along = (point - a).dot(master.tangent(i)), height = height_over(master, i, point);
    const double distance = along < 0                  ? (point - a).norm()
                            : along > master.length(i) ? (point - b).norm()
                                                       : std::abs(height);
    // Distances to a shared end node differ by rounding at most.
    if (distance < (1 - 1e-12) * least ||
        (distance <= (1 + 1e-12) * least && std::abs(height) > std::abs(nearest.height)))
      nearest = {i, height}, least = distance;
  }
  return nearest;
}

/// Sine of the angle between a segment's normal and the direction of a point beyond its ends; 0 beside it.
double sine_beyond(const PresentOutline& master, int segment, const Vec2& point) {
  const double along = (point - master.node(segment)).dot(master.tangent(segment));
  if (along >= 0 && along <= master.length(segment)) return 0;
  const double over = along < 0 ? along : along - master.length(segment);
  return over / std::hypot(over, height_over(master, segment, point));
}

}  // namespace

std::optional<Nearest> nearest_segment(const PresentOutline& master, int first, int count, const Vec2& point,
                                       double outward) {
  std::optional<Nearest> nearest;
  for (int i = first; i < first + count; ++i) {
    if (!wedge_holds(master, i, point)) continue;
    const double height = height_over(master, i, point);
    if (!nearest || std::abs(height) < std::abs(nearest->height)) nearest = Nearest{i, height};
  }
  // Where a face ends before the bisector beside it does, as in a fold, Voronoi regions mislead: they do not count for
  // points steeper than 8 degrees beyond an end.
  if (nearest && nearest->height <= outward && std::abs(sine_beyond(master, nearest->segment, point)) > 0.14)
    return truly_nearest(master, first, count, point);
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
  const JetVector from_end = result.xi.value < 0 ? x - a : x - b;
  // A point at the end itself has no direction from there. By rounding it may be beyond.
  result.beyond &= from_end.x.value != 0 || from_end.y.value != 0;
  if (!result.beyond) return result;
  result.xi = result.xi.value < 0 ? 0 : 1;
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
