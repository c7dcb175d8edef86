#pragma once

#include <cmath>
#include <vector>

#include "geometry/curves.hpp"
#include "geometry/mesh.hpp"
#include "geometry/overlap.hpp"
#include "geometry/placement.hpp"
#include "shapes.hpp"

/// Packings put together in code and what tests ask of them, in units of order one.
namespace pliant::testing {

/// Grains of many sizes of the given shapes, in a strip of period 10 and height 8.
inline Scene packing_scene(PackingKind kind, const std::vector<ShapeSpec>& shapes, double solid_fraction, int count) {
  Scene scene;
  scene.period = 10;
  scene.shapes = shapes;
  Grains grains;
  for (const ShapeSpec& shape : shapes) grains.shapes.push_back({shape.name, 1.0 / static_cast<double>(shapes.size())});
  grains.size.kind = SizeDistribution::Kind::uniform;
  grains.size.low = 0.7;
  grains.size.high = 1.3;
  grains.packing.kind = kind;
  grains.packing.right = 10;
  grains.packing.bottom = -3;
  grains.packing.top = 5;
  grains.packing.solid_fraction = solid_fraction;
  grains.packing.count = count;
  grains.angle = std::nullopt;
  grains.seed = 5;
  scene.grains = {grains};
  return scene;
}

inline Packed pack(const Scene& scene) {
  std::mt19937_64 random(scene.grains[0].seed);
  return place_grains(scene, scene.grains[0], random);
}

/// The outlines of all grains where they lie.
inline std::vector<Points> outlines_of(const Scene& scene, const Packed& packed) {
  std::vector<ShapeSpec> shapes = scene.shapes;
  shapes.insert(shapes.end(), packed.fitted.begin(), packed.fitted.end());
  std::vector<Points> outlines;
  for (const Placement& grain : packed.grains)
    outlines.push_back(placed_outline(make_outline(shapes[grain.shape]), grain));
  return outlines;
}

/// Pairs of outlines that share a point, by the exact test of segments on all pairs, across the period too.
inline int overlapping_pairs(const std::vector<Points>& outlines, const std::optional<double>& period) {
  int count = 0;
  for (std::size_t i = 0; i < outlines.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (const double turn : {-1.0, 0.0, 1.0}) {
        Points other = outlines[j];
        for (Vec2& p : other) p.x() += turn * period.value_or(1000);
        count += polygons_overlap(outlines[i], other);
      }
  return count;
}

inline double covered_area(const std::vector<Points>& outlines) {
  double area = 0;
  for (const Points& outline : outlines) area += polygon_properties(outline).area;
  return area;
}

}  // namespace pliant::testing
