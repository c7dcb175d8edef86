#include "geometry/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "core/errors.hpp"
#include "core/located.hpp"
#include "core/random.hpp"
#include "geometry/grain_cells.hpp"
#include "geometry/mesh.hpp"
#include "geometry/placement.hpp"
#include "geometry/polygon.hpp"
#include "geometry/species_in_turn.hpp"

namespace pliant {
namespace {

int index_of_material(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (scene.materials[i].name == name) return static_cast<int>(i);
  throw InputError(fmt::format("{}: unknown material '{}'", scene.file.string(), name));
}

void require_all(const Grains& grains, const std::vector<int>& choice) {
  for (std::size_t m = 0; m < grains.species.size(); ++m)
    if (grains.species[m].share > 0 && std::find(choice.begin(), choice.end(), static_cast<int>(m)) == choice.end())
      throw InputError(fmt::format(
          "species: a share of {} of {} grains is less than one of '{}'; take more grains, or leave that entry out",
          grains.species[m].share, choice.size(), grains.species[m].material));
}

/// [grains] species of each grain. Throws InputError if an entry with a share gets no grain.
std::vector<int> assign_species(const Grains& grains, int count, std::mt19937_64& random) {
  std::vector<double> shares;
  for (const Species& entry : grains.species) shares.push_back(entry.share);
  const std::vector<int> choice = grains.species_order == SpeciesOrder::in_turn
                                      ? species_in_turn(shares, grains.packing)
                                      : assign_shares(shares, count, random);
  located(grains.where, [&] { require_all(grains, choice); });
  return choice;
}

/// Nodal distance of compliant bodies of a shape, m.
double nodal_distance(const ShapeSpec& shape, const Points& outline) {
  if (shape.spacing) return *shape.spacing;
  // Equilateral triangles, two a node.
  if (shape.nodes) return std::sqrt(2 / std::sqrt(3.0) * polygon_properties(outline).area / *shape.nodes);
  return perimeter(outline) / static_cast<double>(outline.size());
}

/// The cells of a breakable grain, each with a shape of its own, which is added to the scene.
std::vector<PlacedBody> cut(Scene& scene, const Grains& grains, const PlacedBody& grain) {
  const ShapeSpec whole = scene.shapes[grain.shape];
  const Points outline = make_outline(whole);
  const double spacing = perimeter(outline) / static_cast<double>(outline.size());
  std::vector<PlacedBody> cells;
  for (const Points& points :
       cut_into_cells(outline, grains.cells, spacing, grains.seed + static_cast<std::uint64_t>(grain.grain))) {
    ShapeSpec shape;
    shape.name = fmt::format("{}.cell{}", whole.name, scene.shapes.size());  // unique name in the scene
    shape.kind = ShapeKind::polygon;
    shape.points = points;
    shape.spacing = nodal_distance(whole, outline);
    shape.outline_nodes = static_cast<int>(points.size());
    shape.where = whole.where;
    PlacedBody cell = grain;
    cell.shape = static_cast<int>(scene.shapes.size());
    cell.centre = placed_outline({polygon_properties(points).centroid}, {grain.centre, grain.angle, grain.scale})[0];
    cell.offset = cell.centre - grain.centre;
    cells.push_back(std::move(cell));
    scene.shapes.push_back(std::move(shape));
  }
  return cells;
}

void add_grains(Scene& scene, int index, std::vector<PlacedBody>& bodies) {
  const Grains& grains = scene.grains[index];
  const int count = static_cast<int>(grains.packing.grain_count());
  std::mt19937_64 random(grains.seed);
  const std::vector<int> choice = assign_species(grains, count, random);
  Packed packed = place_grains(scene, grains, random);
  for (ShapeSpec& shape : packed.fitted) scene.shapes.push_back(std::move(shape));
  std::vector<PlacedBody> placed;
  for (int i = 0; i < count; ++i) {
    const Species& entry = grains.species[choice[i]];
    const Placement& grain = packed.grains[i];
    PlacedBody body;
    body.grain = i;
    body.kind = entry.body;
    body.grains = index;
    body.shape = grain.shape;
    body.material = index_of_material(scene, entry.material);
    body.centre = grain.centre;
    body.angle = grain.angle;
    body.scale = grain.scale;
    if (grains.cells.empty())
      placed.push_back(std::move(body));
    else
      located(grains.where, [&] { std::ranges::move(cut(scene, grains, body), std::back_inserter(placed)); });
  }
  for (std::size_t i = 0; i < placed.size(); ++i)
    placed[i].name = placed.size() == 1 ? grains.name : fmt::format("{} {}", grains.name, i);
  std::ranges::move(placed, std::back_inserter(bodies));
}

}  // namespace

std::vector<PlacedBody> place_bodies(Scene& scene) {
  std::vector<PlacedBody> bodies;
  for (std::size_t g = 0; g < scene.grains.size(); ++g) add_grains(scene, static_cast<int>(g), bodies);
  for (std::size_t w = 0; w < scene.walls.size(); ++w) {
    const Wall& wall = scene.walls[w];
    PlacedBody body;
    body.name = wall.name;
    body.wall = true;
    body.number_of_wall = static_cast<int>(w);
    body.material = index_of_material(scene, wall.material);
    body.centre = Vec2(0, wall.level);
    bodies.push_back(std::move(body));
  }
  return bodies;
}

Points wall_points(const Scene& scene, const Wall& wall, double finest) {
  const double period = *scene.period, spacing = wall.spacing > 0 ? wall.spacing : finest;
  constexpr double most_nodes = 1e6;
  if (period / spacing > most_nodes)
    throw InputError(fmt::format(
        "{}: wall '{}' has the finest outline spacing of the grains, {:.3g} m, and so {:.3g} nodes; allowed: at "
        "most {:.0g}; give its spacing, or take fewer very small grains",
        wall.where.empty() ? scene.file.string() : wall.where, wall.name, spacing, period / spacing, most_nodes));
  Points points = located(wall.where, [&] { return wall_outline(wall, period, std::min(spacing, period / 8)); });
  for (Vec2& p : points) p.y() -= wall.level;
  return points;
}

}  // namespace pliant
