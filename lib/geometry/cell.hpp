#pragma once

#include <compare>

#include "core/vec2.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Numbers of periods from a body to one of its images. A domain with one period has images along x only.
struct Images {
  int x = 0, y = 0;
  auto operator<=>(const Images&) const = default;
  Images operator-() const { return {-x, -y}; }
  Images operator+(const Images& other) const { return {x + other.x, y + other.y}; }
  Images operator-(const Images& other) const { return {x - other.x, y - other.y}; }
};

/// Differences between neighbouring images of one field. Of positions they are the vectors a and b of the periods, m;
/// of velocities the rates of these, m/s; of forces those that act on them, N/m (docs/method.md 10). With one period a
/// is (period, 0), and b is 0. All are 0 without a period.
struct Lattice {
  double ax = 0, ay = 0, bx = 0, by = 0;
  bool operator==(const Lattice&) const = default;

  Vec2 a() const { return {ax, ay}; }
  Vec2 b() const { return {bx, by}; }
  /// Difference between an image and the body itself.
  Vec2 shift(const Images& images) const { return {images.x * ax + images.y * bx, images.x * ay + images.y * by}; }
};

inline Lattice operator-(const Lattice& p, const Lattice& q) {
  return {p.ax - q.ax, p.ay - q.ay, p.bx - q.bx, p.by - q.by};
}
inline Lattice operator+(const Lattice& p, const Lattice& q) {
  return {p.ax + q.ax, p.ay + q.ay, p.bx + q.bx, p.by + q.by};
}
inline Lattice operator*(double factor, const Lattice& p) {
  return {factor * p.ax, factor * p.ay, factor * p.bx, factor * p.by};
}

/// Lattice of positions at the start of a scene.
inline Lattice initial_lattice(const Scene& scene) {
  if (scene.cell) return {scene.cell->periods.x(), 0, 0, scene.cell->periods.y()};
  return {scene.period.value_or(0), 0, 0, 0};
}

}  // namespace pliant
