#pragma once

#include <string>
#include <vector>

#include "core/vec2.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Body of the scene before any mechanics: its type and its pose at the start.
struct PlacedBody {
  std::string name;  ///< "grains 17", or the wall's name
  BodyKind kind = BodyKind::rigid;
  bool wall = false;
  int grains = -1;          ///< index in Scene::grains; -1 for a wall
  int grain = -1;           ///< number of the grain in its set, which all cells of a breakable grain share
  int number_of_wall = -1;  ///< index in Scene::walls; -1 for a grain
  int shape = -1;           ///< index in Scene::shapes; -1 for a wall
  int material = 0;         ///< index in Scene::materials
  Vec2 centre{0, 0};        ///< m; for a wall (0, level)
  Vec2 offset{0, 0};        ///< of a cell from the centre of its grain, m; 0 for whole grains
  double angle = 0;         ///< rad
  double scale = 1;         ///< size over that of its shape in the scene
};

/// All bodies, grains in the scene's order, then walls. Shapes that packings fit to single grains are added to `scene`.
/// The result is the same on any number of threads. Throws InputError for packings that cannot be made.
std::vector<PlacedBody> place_bodies(Scene& scene);

/// Outline of a wall, [nodes], as wall_outline gives it, y from the wall's level. `finest`: mean segment of the finest
/// outline of the grains, which is the spacing of walls without their own. Throws InputError for more than a million
/// nodes.
Points wall_points(const Scene& scene, const Wall& wall, double finest);

}  // namespace pliant
