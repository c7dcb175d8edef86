#pragma once

#include <string>
#include <vector>

#include "core/vec2.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// A body of the scene before any mechanics: what it is and where it lies at the start.
struct PlacedBody {
  std::string name;  ///< "grains 17", or the wall's name
  BodyKind kind = BodyKind::rigid;
  bool wall = false;
  int grains = -1;          ///< index in Scene::grains; -1 for a wall
  int number_of_wall = -1;  ///< index in Scene::walls; -1 for a grain
  int shape = -1;           ///< index in Scene::shapes; -1 for a wall
  int material = 0;         ///< index in Scene::materials
  Vec2 centre{0, 0};        ///< m; of a wall (0, level)
  double angle = 0;         ///< rad
  double scale = 1;         ///< size over that of its shape as the scene gives it
};

/// All bodies, grains in the scene's order, then walls. `scene` gains the shapes that packings fit to single grains.
/// The same on any number of threads. Throws InputError for packings that cannot be made.
std::vector<PlacedBody> place_bodies(Scene& scene);

/// Outline of a wall, [nodes], as wall_outline gives it, y from the wall's level. `finest`: mean segment of the finest
/// outline of the grains, the spacing of walls that give none. Throws InputError for more than a million nodes.
Points wall_points(const Scene& scene, const Wall& wall, double finest);

}  // namespace pliant
