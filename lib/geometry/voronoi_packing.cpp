#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "geometry/cell_filling.hpp"
#include "geometry/curves.hpp"
#include "geometry/mesh.hpp"
#include "geometry/placement.hpp"
#include "geometry/power_diagram.hpp"

namespace pliant {
namespace {

// Grains in cells with a common edge would touch. They are reduced by this share, so that rounding cannot make them
// overlap.
constexpr double cell_clearance = 1e-6;

/// Shape for placement in cells.
struct Body {
  SupportFunction reach;
  double area = 0;  // of its polygon, m2
};

Body make_body(const ShapeSpec& shape) {
  const Points outline = make_outline(shape);
  return {SupportFunction(outline), polygon_properties(outline).area};
}

/// Copy of a Fourier shape with the phases of a cell.
ShapeSpec fitted_shape(const ShapeSpec& shape, const Points& cell, std::size_t number) {
  ShapeSpec fitted = shape;
  fitted.descriptors.clear();
  fitted.family = shape.name;
  fitted.name = fmt::format("{}.{}", shape.name, number);  // unique name in the scene
  fitted.points = fourier_grain(shape.diameter, shape.descriptors,
                                phases_of_cell(cell, static_cast<int>(shape.descriptors.size())));
  if (fitted.points.empty())
    throw InputError(
        fmt::format("shape '{}': fitted to a cell its radius is not positive all round; take smaller "
                    "descriptors (a sum below 1 never fails)",
                    shape.name));
  return fitted;
}

/// Common factor on all sizes at which the grains, none larger than its cell allows, cover `wanted` m2 (bisection: the
/// area grows with it).
double common_factor(const std::vector<Placement>& grains, const std::vector<CellFit>& fits,
                     const std::vector<double>& areas, double wanted) {
  double low = 0, high = 0;
  for (std::size_t i = 0; i < grains.size(); ++i) high = std::max(high, fits[i].scale / grains[i].scale);
  for (int step = 0; step < 60; ++step) {
    const double middle = (low + high) / 2;
    double area = 0;
    for (std::size_t i = 0; i < grains.size(); ++i)
      area += areas[i] * std::pow(std::min(fits[i].scale, middle * grains[i].scale), 2);
    (area < wanted ? low : high) = middle;
  }
  return high;
}

/// Shapes by index: those of the scene that occur, and those fitted to cells.
std::map<int, Body> make_bodies(const std::vector<Placement>& grains, const std::vector<ShapeSpec>& shapes,
                                const std::vector<ShapeSpec>& fitted) {
  std::map<int, Body> bodies;
  const int known = static_cast<int>(shapes.size());
  for (const Placement& grain : grains)
    if (!bodies.contains(grain.shape))
      bodies.emplace(grain.shape, make_body(grain.shape < known ? shapes[grain.shape] : fitted[grain.shape - known]));
  return bodies;
}

double nominal_area(const ShapeSpec& shape) {
  return shape.kind == ShapeKind::disc ? M_PI / 4 * shape.diameter * shape.diameter
                                       : polygon_properties(shape.points).area;
}

/// Areas of cells in proportion to those of their grains.
std::vector<double> wanted_areas(const std::vector<Placement>& grains, const std::vector<ShapeSpec>& shapes,
                                 double region) {
  std::vector<double> areas;
  double sum = 0;
  for (const Placement& grain : grains) {
    areas.push_back(grain.scale * grain.scale * nominal_area(shapes[grain.shape]));
    sum += areas.back();
  }
  for (double& area : areas) area *= region / sum;
  return areas;
}

std::vector<ShapeSpec> fit_shapes(std::vector<Placement>& grains, const std::vector<ShapeSpec>& shapes,
                                  const std::vector<Points>& cells) {
  std::vector<ShapeSpec> fitted;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const ShapeSpec& shape = shapes[grains[i].shape];
    if (shape.descriptors.empty()) continue;
    fitted.push_back(fitted_shape(shape, cells[i], shapes.size() + fitted.size() + 1));
    grains[i].shape = static_cast<int>(shapes.size() + fitted.size()) - 1;
  }
  return fitted;
}

void require_cells(const std::vector<Points>& cells) {
  const auto lost = std::find_if(cells.begin(), cells.end(), [](const Points& cell) { return cell.empty(); });
  if (lost != cells.end())
    throw InputError(
        fmt::format("packing: grain {} is so small beside the others that it has no cell; take a narrower "
                    "size distribution or another seed",
                    lost - cells.begin()));
}

void set_sizes(std::vector<Placement>& grains, const std::vector<CellFit>& fits, const std::vector<double>& areas,
               double region, double solid_fraction) {
  double most = 0;
  for (std::size_t i = 0; i < grains.size(); ++i) most += areas[i] * fits[i].scale * fits[i].scale;
  if (solid_fraction * region > most)
    throw InputError(
        fmt::format("packing: a solid fraction of {} does not fit the cells, which hold {:.4f}; ask for "
                    "less and press the grains together, or take rounder shapes",
                    solid_fraction, most / region));
  const double factor = common_factor(grains, fits, areas, solid_fraction * region);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    grains[i].scale = std::min(fits[i].scale, factor * grains[i].scale);
    grains[i].angle = fits[i].angle;
    grains[i].centre = fits[i].centre;
  }
}

}  // namespace

std::vector<ShapeSpec> pack_voronoi(std::vector<Placement>& grains, const std::vector<ShapeSpec>& shapes,
                                    const Strip& region, double solid_fraction, std::uint64_t seed) {
  const std::vector<Points> cells = cells_of_areas(wanted_areas(grains, shapes, region.area()), region, seed);
  require_cells(cells);
  std::vector<ShapeSpec> fitted = fit_shapes(grains, shapes, cells);
  const std::map<int, Body> bodies = make_bodies(grains, shapes, fitted);
  std::vector<CellFit> fits(grains.size());
  std::vector<double> areas(grains.size());
  parallel_for(static_cast<int>(grains.size()), [&](int i) {
    const Body& body = bodies.at(grains[i].shape);
    fits[i] = largest_in_cell(cells[i], body.reach);
    fits[i].scale *= 1 - cell_clearance;
    areas[i] = body.area;
  });
  set_sizes(grains, fits, areas, region.area(), solid_fraction);
  return fitted;
}

}  // namespace pliant
