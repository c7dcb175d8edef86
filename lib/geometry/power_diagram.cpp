#include "geometry/power_diagram.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "core/random.hpp"
#include "geometry/mesh.hpp"

namespace pliant {
namespace {

// More sweeps make cells rounder and the packing more like a lattice; by then the areas agree to a percent or so.
constexpr int sweeps = 60;

/// Keeps the part of a convex polygon where normal . x <= offset.
void clip(Points& polygon, const Vec2& normal, double offset) {
  Points kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double above_a = normal.dot(a) - offset, above_b = normal.dot(b) - offset;
    if (above_a <= 0) kept.push_back(a);
    if ((above_a < 0 && above_b > 0) || (above_a > 0 && above_b < 0))
      kept.push_back(a + above_a / (above_a - above_b) * (b - a));
  }
  polygon = std::move(kept);
}

/// Generators sorted into square bins, for searches outwards from one of them.
class Bins {
 public:
  Bins(const Points& points, const Strip& region)
      : region_(region),
        columns_(std::max(1, static_cast<int>(region.width() / target(points, region)))),
        rows_(std::max(1, static_cast<int>(region.height() / target(points, region)))),
        members_(static_cast<std::size_t>(columns_) * rows_) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int column = std::clamp(static_cast<int>((points[i].x() - region.left) / width()), 0, columns_ - 1);
      const int row = std::clamp(static_cast<int>((points[i].y() - region.bottom) / height()), 0, rows_ - 1);
      place_.push_back({column, row});
      members_[static_cast<std::size_t>(row) * columns_ + column].push_back(static_cast<int>(i));
    }
  }

  /// Calls visit(other, shift of its image) for all points in the bins `ring` bins away from that of point i.
  template <class Visit>
  void ring(int i, int ring, Visit&& visit) const {
    const auto [column, row] = place_[i];
    for (int dy = -ring; dy <= ring; ++dy) {
      const int laps = static_cast<int>(std::floor(static_cast<double>(row + dy) / rows_));
      if (laps != 0 && !region_.periodic_y) continue;
      const int step = std::abs(dy) == ring ? 1 : std::max(1, 2 * ring);
      for (int dx = -ring; dx <= ring; dx += step) {
        const int turns = static_cast<int>(std::floor(static_cast<double>(column + dx) / columns_));
        const int at = column + dx - turns * columns_;
        for (const int other : members_[static_cast<std::size_t>(row + dy - laps * rows_) * columns_ + at])
          visit(other, Vec2(turns * region_.width(), laps * region_.height()));
      }
    }
  }

  /// Least distance of points in a ring and beyond from the point in its centre.
  double distance(int ring) const { return (ring - 1) * std::min(width(), height()); }

 private:
  static double target(const Points& points, const Strip& region) {
    return std::sqrt(region.area() / static_cast<double>(points.size()));
  }
  double width() const { return region_.width() / columns_; }
  double height() const { return region_.height() / rows_; }

  const Strip& region_;
  int columns_, rows_;
  std::vector<std::vector<int>> members_;
  std::vector<std::pair<int, int>> place_;
};

double radius_about(const Points& polygon, const Vec2& x) {
  double largest = 0;
  for (const Vec2& p : polygon) largest = std::max(largest, (p - x).norm());
  return largest;
}

Points power_cell(int i, const Points& generators, const std::vector<double>& weights, double largest_weight,
                  const Strip& region, const Bins& bins) {
  const Vec2& x = generators[i];
  const double half = region.width() / 2;
  const double bottom = region.periodic_y ? x.y() - region.height() / 2 : region.bottom,
               top = region.periodic_y ? x.y() + region.height() / 2 : region.top;
  Points cell{{x.x() - half, bottom}, {x.x() + half, bottom}, {x.x() + half, top}, {x.x() - half, top}};
  for (int ring = 0; !cell.empty(); ++ring) {
    // Bisectors with generators at a distance d are at least (d^2 + w_i - w_max)/(2 d) away, increasing with d.
    const double d = bins.distance(ring);
    if (d > 0 && (d * d + weights[i] - largest_weight) / (2 * d) >= radius_about(cell, x)) break;
    bins.ring(i, ring, [&](int j, const Vec2& shift) {
      const Vec2 other = generators[j] + shift, apart = other - x;
      if (apart.squaredNorm() == 0) return;
      const double offset = apart.dot(x) + (apart.squaredNorm() + weights[i] - weights[j]) / 2;
      clip(cell, apart, offset);
    });
  }
  if (cell.size() < 3) cell.clear();
  return cell;
}

Vec2 wrapped(Vec2 x, const Strip& region) {
  x.x() -= std::floor((x.x() - region.left) / region.width()) * region.width();
  if (region.periodic_y) x.y() -= std::floor((x.y() - region.bottom) / region.height()) * region.height();
  return x;
}

}  // namespace

std::vector<Points> power_cells(const Points& generators, const std::vector<double>& weights, const Strip& region) {
  const Bins bins(generators, region);
  const double largest = *std::max_element(weights.begin(), weights.end());
  std::vector<Points> cells(generators.size());
  parallel_for(static_cast<int>(generators.size()),
               [&](int i) { cells[i] = power_cell(i, generators, weights, largest, region, bins); });
  return cells;
}

std::vector<Points> cells_of_areas(const std::vector<double>& areas, const Strip& region, std::uint64_t seed) {
  std::mt19937_64 random = random_stream(seed, 3);
  Points generators;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const double x = uniform_number(random), y = uniform_number(random);
    generators.emplace_back(region.left + x * region.width(), region.bottom + y * region.height());
  }
  std::vector<double> weights(areas.size(), 0.0);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const std::vector<Points> cells = power_cells(generators, weights, region);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const PolygonProperties cell = polygon_properties(cells[i]);
      if (cell.area > 0) generators[i] = wrapped(cell.centroid, region);
      // dA/dw of a regular hexagon is sqrt(3), and neighbours move against it: 1/pi is about the largest stable step.
      weights[i] += (areas[i] - cell.area) / std::numbers::pi;
    }
  }
  return power_cells(generators, weights, region);
}

}  // namespace pliant
