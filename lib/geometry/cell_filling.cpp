#include "geometry/cell_filling.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "geometry/mesh.hpp"

namespace pliant {
namespace {

using std::numbers::pi;

// One degree: the error of the scale beside the best angle is some 1e-3 at most.
constexpr int angles = 360;
constexpr int contour_angles = 360;

struct HalfPlane {
  Vec2 normal{0, 0};
  double direction = 0, offset = 0;  // normal = (cos, sin)(direction); inside: normal . x <= offset
};

std::vector<HalfPlane> half_planes(const Points& cell) {
  std::vector<HalfPlane> planes;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const Vec2 edge = cell[(i + 1) % cell.size()] - cell[i];
    const double length = edge.norm();
    if (length == 0) continue;
    HalfPlane plane;
    plane.normal = Vec2(edge.y(), -edge.x()) / length;
    plane.direction = std::atan2(plane.normal.y(), plane.normal.x());
    plane.offset = plane.normal.dot(cell[i]);
    planes.push_back(plane);
  }
  return planes;
}

/// Three half-planes that enclose a triangle: a basis of the dual programme, whose normals balance with positive
/// weights.
struct Basis {
  int plane[3];
  double weight[3];
  double offset;  // weighted sum of offsets
};

std::vector<Basis> enclosing_triples(const std::vector<HalfPlane>& planes) {
  std::vector<Basis> bases;
  const int n = static_cast<int>(planes.size());
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      for (int k = j + 1; k < n; ++k) {
        const Vec2 &a = planes[i].normal, &b = planes[j].normal, &c = planes[k].normal;
        Basis basis{{i, j, k}, {cross(b, c), cross(c, a), cross(a, b)}, 0};
        for (int t = 0; t < 3; ++t) basis.offset += basis.weight[t] * planes[basis.plane[t]].offset;
        // Edges run counter-clockwise, so all three are positive if the triple encloses something.
        if (basis.weight[0] > 0 && basis.weight[1] > 0 && basis.weight[2] > 0) bases.push_back(basis);
      }
  return bases;
}

/// The binding triple and the scale that it allows, for given values of the support function towards each plane.
std::pair<const Basis*, double> least_scale(const std::vector<Basis>& bases, const std::vector<double>& reach) {
  const Basis* binding = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Basis& basis : bases) {
    const double needed = basis.weight[0] * reach[basis.plane[0]] + basis.weight[1] * reach[basis.plane[1]] +
                          basis.weight[2] * reach[basis.plane[2]];
    if (basis.offset < least * needed) least = basis.offset / needed, binding = &basis;
  }
  return {binding, least};
}

/// Centre at which two of the binding planes are touched: those that are closest to perpendicular.
Vec2 centre_of(const Basis& basis, const std::vector<HalfPlane>& planes, const std::vector<double>& reach,
               double scale) {
  const int left_out = static_cast<int>(std::max_element(basis.weight, basis.weight + 3) - basis.weight);
  const int p = basis.plane[(left_out + 1) % 3], q = basis.plane[(left_out + 2) % 3];
  const Vec2 &a = planes[p].normal, &b = planes[q].normal;
  const double at_a = planes[p].offset - scale * reach[p], at_b = planes[q].offset - scale * reach[q];
  return Vec2(at_a * b.y() - at_b * a.y(), at_b * a.x() - at_a * b.x()) / cross(a, b);
}

}  // namespace

SupportFunction::SupportFunction(const Points& outline) : outline_(outline) {
  for (int k = 0; k < directions; ++k) table_.push_back(exact(2 * pi * k / directions));
}

double SupportFunction::exact(double theta) const {
  const Vec2 direction(std::cos(theta), std::sin(theta));
  double largest = -std::numeric_limits<double>::infinity();
  for (const Vec2& p : outline_) largest = std::max(largest, p.dot(direction));
  return largest;
}

double SupportFunction::nearest(double theta) const {
  const int k = static_cast<int>(std::lround(theta / (2 * pi) * directions)) % directions;
  return table_[static_cast<std::size_t>(k < 0 ? k + directions : k)];
}

CellFit largest_in_cell(const Points& cell, const SupportFunction& body) {
  // Relative to a corner, so that a small cell far from the origin loses no digits.
  Points local;
  for (const Vec2& p : cell) local.push_back(p - cell[0]);
  const std::vector<HalfPlane> planes = half_planes(local);
  const std::vector<Basis> bases = enclosing_triples(planes);
  CellFit best;
  std::vector<double> reach(planes.size());
  for (int k = 0; k < angles; ++k) {
    const double angle = 2 * pi * k / angles;
    for (std::size_t i = 0; i < planes.size(); ++i) reach[i] = body.nearest(planes[i].direction - angle);
    const double scale = least_scale(bases, reach).second;
    if (scale > best.scale) best.scale = scale, best.angle = angle;
  }
  for (std::size_t i = 0; i < planes.size(); ++i) reach[i] = body.exact(planes[i].direction - best.angle);
  const auto [binding, scale] = least_scale(bases, reach);
  best.scale = scale;
  best.centre = cell[0] + centre_of(*binding, planes, reach, scale);
  return best;
}

std::vector<double> phases_of_cell(const Points& cell, int count) {
  const Vec2 centre = polygon_properties(cell).centroid;
  const std::vector<HalfPlane> planes = half_planes(cell);
  std::vector<std::complex<double>> harmonics(static_cast<std::size_t>(count));
  for (int k = 0; k < contour_angles; ++k) {
    const double theta = 2 * pi * k / contour_angles;
    const Vec2 direction(std::cos(theta), std::sin(theta));
    double radius = std::numeric_limits<double>::infinity();
    for (const HalfPlane& plane : planes) {
      const double along = plane.normal.dot(direction);
      if (along > 0) radius = std::min(radius, (plane.offset - plane.normal.dot(centre)) / along);
    }
    // r = sum c_n exp(i n theta) with c_n = |c_n| exp(i phase), as in cos(n theta + phase).
    for (std::size_t i = 0; i < harmonics.size(); ++i)
      harmonics[i] += radius * std::polar(1.0, -static_cast<double>(i + 2) * theta);
  }
  std::vector<double> phases;
  for (const auto& harmonic : harmonics) phases.push_back(std::arg(harmonic));
  return phases;
}

}  // namespace pliant
