#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.hpp"
#include "core/random.hpp"
#include "geometry/grain_relaxation.hpp"
#include "geometry/mesh.hpp"
#include "geometry/placement.hpp"

namespace pliant {
namespace {

// Share of the region that the circles around the grains cover at the start, where random positions without overlap are
// easily found. From there grains grow in small steps, so that none penetrates another deeply, where the direction of
// separation would be ambiguous.
constexpr double first_coverage = 0.2;
constexpr double fastest_growth = 1.15, slowest_growth = 1.01;
constexpr int tries = 1000;
constexpr int sweeps_while_growing = 400, sweeps_at_full_size = 6000;

void require_room(double largest, const Strip& region) {
  if (region.periodic && region.width() < 2.2 * largest)
    throw InputError(
        fmt::format("packing: the largest grain is {:.3g} m wide in a period of {:.3g} m; a random "
                    "packing needs a period of at least 2.2 times that",
                    largest, region.width()));
  if (region.periodic_y && region.height() < 2.2 * largest)
    throw InputError(
        fmt::format("packing: the largest grain is {:.3g} m wide in a period of {:.3g} m along y; a random "
                    "packing needs a period of at least 2.2 times that",
                    largest, region.height()));
  if (largest < region.width() && largest < region.height()) return;
  throw InputError(
      fmt::format("packing: the largest grain is {:.3g} m wide, the region {:.3g} m x {:.3g} m; take "
                  "smaller grains or a larger region",
                  largest, region.width(), region.height()));
}

/// Random centre with the circle around the grain inside the region.
Vec2 random_place(double rim, const Strip& region, std::mt19937_64& random) {
  const double side = region.periodic ? 0 : rim, end = region.periodic_y ? 0 : rim;
  const double x = uniform_number(random), y = uniform_number(random);
  return {region.left + side + x * (region.width() - 2 * side), region.bottom + end + y * (region.height() - 2 * end)};
}

class Growth {
 public:
  Growth(std::vector<Placement>& grains, const std::vector<Points>& outlines, const Strip& region,
         const std::vector<WallProfile>& walls, bool turn)
      : grains_(grains),
        outlines_(outlines),
        region_(region),
        turn_(turn),
        relaxation_(grains, outlines, region, walls, turn) {
    double largest = 0;
    for (const Placement& grain : grains) {
      full_.push_back(grain.scale);
      largest = std::max(largest, 2 * relaxation_.radius(grain));
    }
    require_room(largest, region);
  }

  /// Places small grains at random positions without overlap of their circles; returns their share of the full size.
  double scatter(std::uint64_t seed) {
    std::mt19937_64 random = random_stream(seed, 4);
    double circles = 0;
    for (const Placement& grain : grains_) circles += std::numbers::pi * std::pow(relaxation_.radius(grain), 2);
    const double share = std::min(1.0, std::sqrt(first_coverage * region_.area() / circles));
    resize(share);
    for (std::size_t i = 0; i < grains_.size(); ++i) {
      if (turn_) grains_[i].angle = 2 * std::numbers::pi * uniform_number(random);
      for (int k = 0; k < tries && (k == 0 || near_others(i)); ++k)
        grains_[i].centre = random_place(relaxation_.radius(grains_[i]), region_, random);
    }
    return share;
  }

  /// Relaxes the grains at this share of their size. Returns whether no overlap remains.
  bool relax(double share) {
    resize(share);
    return relaxation_.relax(share < 1 ? sweeps_while_growing : sweeps_at_full_size);
  }

  double solid_fraction() const {
    double area = 0;
    for (const Placement& grain : grains_)
      area += polygon_properties(outlines_[grain.shape]).area * grain.scale * grain.scale;
    return area / region_.area();
  }

 private:
  void resize(double share) {
    for (std::size_t i = 0; i < grains_.size(); ++i) grains_[i].scale = share * full_[i];
  }

  /// Whether the circle around a grain overlaps that of one placed before.
  bool near_others(std::size_t i) const {
    const double own = relaxation_.radius(grains_[i]);
    for (std::size_t j = 0; j < i; ++j)
      if (relaxation_.apart(grains_[i], grains_[j]).norm() < own + relaxation_.radius(grains_[j])) return true;
    return false;
  }

  std::vector<Placement>& grains_;
  const std::vector<Points>& outlines_;
  Strip region_;
  bool turn_;
  GrainRelaxation relaxation_;
  std::vector<double> full_;  // scales at full size
};

}  // namespace

void pack_randomly(std::vector<Placement>& grains, const std::vector<Points>& outlines, const Strip& region,
                   const std::vector<WallProfile>& walls, bool turn, std::uint64_t seed) {
  Growth growth(grains, outlines, region, walls, turn);
  if (growth.solid_fraction() > 1)
    throw InputError(
        fmt::format("packing: {} grains have {:.3g} times the area of their region; take fewer or smaller grains",
                    grains.size(), growth.solid_fraction()));
  double reached = 0;
  for (double share = growth.scatter(seed);;) {
    const bool free = growth.relax(share);
    if (free && share == 1) return;
    if (free) reached = growth.solid_fraction();
    if (share == 1) break;
    // Half of the remaining growth, within limits: growth becomes slow where it becomes crowded.
    share = std::min(1.0, share * std::clamp(1 + (1 - share) / 2, slowest_growth, fastest_growth));
  }
  throw InputError(
      fmt::format("packing: {} grains of solid fraction {:.4f} do not come free of each other; without overlap "
                  "{:.4f} was reached: take fewer or smaller grains, and press them together",
                  grains.size(), growth.solid_fraction(), reached));
}

}  // namespace pliant
