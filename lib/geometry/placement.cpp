#include "geometry/placement.hpp"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "core/located.hpp"
#include "core/random.hpp"
#include "geometry/mesh.hpp"
#include "geometry/sizes.hpp"
#include "geometry/wall_profile.hpp"

namespace pliant {
namespace {

/// Draws shapes and sizes, each in its own random order; grains are not placed yet.
std::vector<Placement> draw_grains(const Scene& scene, const Grains& grains) {
  const Packing& packing = grains.packing;
  const int count = static_cast<int>(packing.grain_count());
  std::vector<double> shares;
  const auto members = scene.shape_shares(grains);
  for (const auto& member : members) shares.push_back(member.second);
  std::mt19937_64 random = random_stream(grains.seed, 2);
  const std::vector<int> shapes = assign_shares(shares, count, random);
  const std::vector<double> sizes = draw_sizes(grains.size, count, grains.seed);
  std::vector<Placement> placements(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    placements[i].shape = packing.shapes.empty() ? members[shapes[i]].first : packing.shapes[i];
    placements[i].scale = packing.scales.empty() ? sizes[i] : packing.scales[i];
    if (!packing.diameters.empty())
      placements[i].scale = packing.diameters[i] / equivalent_diameter(scene.shapes[placements[i].shape]);
  }
  return placements;
}

void place_on_lattice(const Scene& scene, const Grains& grains, std::mt19937_64& random,
                      std::vector<Placement>& placements) {
  const Points centres = packing_positions(grains.packing, scene.period);
  for (std::size_t i = 0; i < placements.size(); ++i) {
    placements[i].centre = centres[i];
    placements[i].angle = !grains.packing.angles.empty() ? grains.packing.angles[i]
                          : grains.angle                 ? *grains.angle
                                                         : 2 * std::numbers::pi * uniform_number(random);
  }
}

/// [shapes] outlines of the shapes that occur.
std::vector<Points> outlines_of(const Scene& scene, const std::vector<Placement>& placements) {
  std::vector<Points> outlines(scene.shapes.size());
  for (const Placement& grain : placements)
    if (outlines[grain.shape].empty()) {
      const ShapeSpec& shape = scene.shapes[grain.shape];
      outlines[grain.shape] = located(shape.where, [&] { return make_outline(shape); });
    }
  return outlines;
}

/// Walls whose asperities, or levels, reach into the region that grains fill.
std::vector<WallProfile> walls_in(const Scene& scene, const Strip& region) {
  std::vector<WallProfile> profiles;
  for (const Wall& wall : scene.walls) {
    // Points on asperities: the error between them is 1e-3 of an asperity's radius.
    const double spacing =
        std::min(*scene.period / 8, wall.asperities ? wall.asperities->diameter / 20 : *scene.period / 8);
    WallProfile profile = located(wall.where, [&] { return WallProfile(wall, *scene.period, spacing); });
    if (profile.reaches_into(region)) profiles.push_back(std::move(profile));
  }
  return profiles;
}

/// Throws InputError if a grain overlaps a wall, for packings that ignore walls.
void refuse_overlap(const Scene& scene, const Packed& packed, const std::vector<WallProfile>& walls) {
  for (const WallProfile& wall : walls)
    for (std::size_t i = 0; i < packed.grains.size(); ++i) {
      const Placement& grain = packed.grains[i];
      const int scenes = static_cast<int>(scene.shapes.size());
      const ShapeSpec& shape = grain.shape < scenes ? scene.shapes[grain.shape] : packed.fitted[grain.shape - scenes];
      if (wall.overlaps(placed_outline(make_outline(shape), grain)))
        throw InputError(fmt::format(
            "packing: grain {} overlaps the wall '{}', which goes to y = {:.6g} m; let the region end there", i,
            wall.name(), wall.extreme()));
    }
}

}  // namespace

Points placed_outline(const Points& outline, const Placement& grain) {
  const double c = grain.scale * std::cos(grain.angle), s = grain.scale * std::sin(grain.angle);
  Points placed;
  placed.reserve(outline.size());
  for (const Vec2& p : outline)
    placed.emplace_back(grain.centre.x() + c * p.x() - s * p.y(), grain.centre.y() + s * p.x() + c * p.y());
  return placed;
}

Packed place_grains(const Scene& scene, const Grains& grains, std::mt19937_64& random) {
  const Packing& packing = grains.packing;
  const Strip region{packing.left, packing.right,       packing.bottom,
                     packing.top,  scene.is_periodic(), scene.cell.has_value()};
  Packed packed{draw_grains(scene, grains), {}};
  const bool fills = packing.kind == PackingKind::random || packing.kind == PackingKind::fourier_voronoi;
  const std::vector<WallProfile> walls = fills ? walls_in(scene, region) : std::vector<WallProfile>{};
  std::vector<Points> outlines;
  if (packing.kind == PackingKind::random) outlines = outlines_of(scene, packed.grains);
  located(grains.where, [&] {
    switch (packing.kind) {
      case PackingKind::random:
        for (Placement& grain : packed.grains) grain.angle = grains.angle.value_or(0);
        pack_randomly(packed.grains, outlines, region, walls, !grains.angle, grains.seed);
        break;
      case PackingKind::fourier_voronoi:
        packed.fitted = pack_voronoi(packed.grains, scene.shapes, region, *packing.solid_fraction, grains.seed);
        refuse_overlap(scene, packed, walls);
        break;
      default:
        place_on_lattice(scene, grains, random, packed.grains);
    }
  });
  return packed;
}

}  // namespace pliant
