#include "geometry/placement.hpp"

#include <numbers>

#include "core/random.hpp"
#include "geometry/mesh.hpp"
#include "scene/sizes.hpp"

namespace pliant {
namespace {

/// Shapes and sizes, each in its own random order; nothing is placed yet.
std::vector<Placement> draw_grains(const Scene& scene, const Grains& grains) {
  const int count = static_cast<int>(grains.packing.grain_count());
  std::vector<double> shares;
  const auto members = scene.shape_shares(grains);
  for (const auto& member : members) shares.push_back(member.second);
  std::mt19937_64 random = random_stream(grains.seed, 2);
  const std::vector<int> shapes = assign_shares(shares, count, random);
  const std::vector<double> sizes = draw_sizes(grains.size, count, grains.seed);
  std::vector<Placement> placements(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    placements[i].shape = members[shapes[i]].first;
    placements[i].scale = sizes[i];
  }
  return placements;
}

void place_on_lattice(const Scene& scene, const Grains& grains, std::mt19937_64& random,
                      std::vector<Placement>& placements) {
  const Points centres = packing_positions(grains.packing, scene.period);
  for (std::size_t i = 0; i < placements.size(); ++i) {
    placements[i].centre = centres[i];
    placements[i].angle = grains.angle ? *grains.angle : 2 * std::numbers::pi * uniform_number(random);
  }
}

/// Outlines of the shapes that occur, [shapes].
std::vector<Points> outlines_of(const Scene& scene, const std::vector<Placement>& placements) {
  std::vector<Points> outlines(scene.shapes.size());
  for (const Placement& grain : placements)
    if (outlines[grain.shape].empty()) outlines[grain.shape] = make_outline(scene.shapes[grain.shape]);
  return outlines;
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
  const Strip region{packing.left, packing.right, packing.bottom, packing.top, scene.period.has_value()};
  Packed packed{draw_grains(scene, grains), {}};
  switch (packing.kind) {
    case PackingKind::random:
      for (Placement& grain : packed.grains) grain.angle = grains.angle.value_or(0);
      pack_randomly(packed.grains, outlines_of(scene, packed.grains), region, !grains.angle, grains.seed);
      break;
    case PackingKind::fourier_voronoi:
      packed.fitted = pack_voronoi(packed.grains, scene.shapes, region, *packing.solid_fraction, grains.seed);
      break;
    default:
      place_on_lattice(scene, grains, random, packed.grains);
  }
  return packed;
}

}  // namespace pliant
