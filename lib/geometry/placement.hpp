#pragma once

#include <random>
#include <vector>

#include "core/vec2.hpp"
#include "scene/scene.hpp"

namespace pliant {

/// Pose, size and shape of one grain.
struct Placement {
  Vec2 centre{0, 0};  ///< m
  double angle = 0;   ///< rad
  double scale = 1;   ///< size over that of its shape
  int shape = 0;      ///< index in Scene::shapes; beyond its end, in Packed::fitted
};

struct Packed {
  std::vector<Placement> grains;
  std::vector<ShapeSpec> fitted;  ///< shapes that belong to one grain each; most packings have none
};

/// Places a set of grains of the scene. `random` gives the angles of grains on lattices; other random quantities have
/// their own engines, from the grains' seed. The result is the same on any number of threads. Throws InputError if the
/// grains do not fit.
Packed place_grains(const Scene& scene, const Grains& grains, std::mt19937_64& random);

/// Region that grains fill: a box, a strip that is periodic in x, or a cell that is so in x and y.
struct Strip {
  double left = 0, right = 0, bottom = 0, top = 0;  ///< m
  bool periodic = false;                            ///< in x
  bool periodic_y = false;                          ///< in y, and so in x
  double width() const { return right - left; }
  double height() const { return top - bottom; }
  double area() const { return width() * height(); }
};

class WallProfile;

/// Outline of a placed grain, m.
Points placed_outline(const Points& outline, const Placement& grain);

/// Random packing without overlap: grains at random positions grow to their size and push each other away. Sizes and
/// shapes are given; centres and, with `turn`, angles are found. `outlines`: of the shapes by index; `walls`: those
/// that reach into the region. Throws InputError with the solid fraction that was reached if overlaps remain.
void pack_randomly(std::vector<Placement>& grains, const std::vector<Points>& outlines, const Strip& region,
                   const std::vector<WallProfile>& walls, bool turn, std::uint64_t seed);

/// Packing of grains in the cells of a Voronoi diagram of a periodic strip or cell, after G. Mollon and J. Zhao,
/// Granular Matter 14 (2012) 621, doi 10.1007/s10035-012-0356-x. Areas of cells are in proportion to scale^2 x area.
/// Each cell is filled by its grain, rotated and translated so that it becomes as large as its cell allows. `grains`
/// have shapes and sizes relative to each other at first, and a full placement then; these sizes are kept as far as
/// their cells have room. A shape with descriptors is fitted to each of its cells: the returned shapes. Throws
/// InputError with the largest possible solid fraction if the requested one does not fit.
std::vector<ShapeSpec> pack_voronoi(std::vector<Placement>& grains, const std::vector<ShapeSpec>& shapes,
                                    const Strip& region, double solid_fraction, std::uint64_t seed);

}  // namespace pliant
