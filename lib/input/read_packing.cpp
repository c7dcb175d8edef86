#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/grain_file.hpp"
#include "geometry/polygon_rules.hpp"
#include "geometry/sizes.hpp"
#include "input/read_tables.hpp"
#include "scene/line_reader.hpp"

namespace pliant {

namespace {

PackingKind kind_of(PackingName name) {
  switch (name) {
    case PackingName::hexagonal:
      return PackingKind::hexagonal;
    case PackingName::grid:
      return PackingKind::grid;
    case PackingName::random:
      return PackingKind::random;
    case PackingName::fourier_voronoi:
      return PackingKind::fourier_voronoi;
    default:
      return PackingKind::positions;
  }
}

void read_lattice(TableReader& table, Packing& packing) {
  table.required("columns", packing.columns);
  table.required("rows", packing.rows);
  table.required("pitch", packing.pitch);
  // A hexagonal packing of columns that touch: the rows of a column lie one diameter apart.
  packing.row_pitch = packing.kind == PackingKind::hexagonal ? packing.pitch * 2 / std::sqrt(3.0) : packing.pitch;
  table.optional("row_pitch", packing.row_pitch);
  table.optional("origin", packing.origin);
}

void check_fit(const TableReader& table, const Packing& packing, double period) {
  constexpr double rounding = 1e-9;  // periods and pitches are decimal numbers of the user
  const double width = packing.columns * packing.pitch;
  if (width > period * (1 + rounding)) {
    table.fail("columns", fmt::format("{} columns at a pitch of {} m take {} m; allowed: at most the period, {} m",
                                      packing.columns, packing.pitch, width, period));
  }
  const bool closed = width >= period * (1 - rounding);
  if (packing.kind == PackingKind::hexagonal && closed && packing.columns % 2 == 1) {
    table.fail("columns",
               fmt::format("{} hexagonal columns fill the period, so two unshifted ones would meet; allowed: "
                           "an even number",
                           packing.columns));
  }
}

void check_fit_in_cell(const TableReader& table, const Packing& packing, const Vec2& periods) {
  constexpr double rounding = 1e-9;
  check_fit(table, packing, periods.x());
  const double height = packing.rows * packing.row_pitch;
  if (height > periods.y() * (1 + rounding))
    table.fail("rows", fmt::format("{} rows at a pitch of {} m take {} m; allowed: at most the period, {} m",
                                   packing.rows, packing.row_pitch, height, periods.y()));
}

/// The part of the plane that grains are to fill.
void read_region(TableReader& table, const Scene& scene, Packing& packing) {
  if (scene.cell) {
    packing.right = scene.cell->periods.x(), packing.top = scene.cell->periods.y();
    return;
  }
  table.required("bottom", packing.bottom);
  table.required("top", packing.top, Range{.low = packing.bottom, .low_open = true});
  if (scene.period) {
    packing.left = 0, packing.right = *scene.period;
    return;
  }
  if (packing.kind == PackingKind::fourier_voronoi)
    table.fail("kind", "the scene has no period, which these cells need; add [domain] period, or take \"random\"");
  table.required("left", packing.left);
  table.required("right", packing.right, Range{.low = packing.left, .low_open = true});
}

/// As many grains as give the solid fraction at the sizes that they have.
int count_for(const TableReader& table, const Scene& scene, const Grains& grains, const Packing& packing) {
  double area = 0;
  for (const auto& [shape, share] : scene.shape_shares(grains))
    area += share * area_of(scene.shapes[static_cast<std::size_t>(shape)]);
  area *= mean_square_size(grains.size);
  const double region = (packing.right - packing.left) * (packing.top - packing.bottom);
  const double count = std::round(*packing.solid_fraction * region / area);
  if (count < 1)
    table.fail("solid_fraction", fmt::format("one grain has {:.3g} of the region's area; allowed: a larger fraction or "
                                             "region, or smaller grains",
                                             area / region));
  if (count > static_cast<double>(SceneLimits::bodies))
    table.fail("solid_fraction",
               fmt::format("{:.3g} grains; allowed: at most {}, so larger ones", count, SceneLimits::bodies));
  return static_cast<int>(count);
}

/// Either key says how many grains of their own size there are; with both, grains take the size that fits, where they
/// may.
void read_filling(TableReader& table, const Scene& scene, const Grains& grains, Packing& packing) {
  read_region(table, scene, packing);
  const bool sized = packing.kind == PackingKind::random;
  const bool counted = table.optional("count", packing.count);
  if (sized && counted && table.has("solid_fraction"))
    table.fail("solid_fraction", "both it and 'count' are given; remove one");
  if (sized && !counted && !table.has("solid_fraction"))
    table.fail_missing("solid_fraction", "'solid_fraction' (a number) or 'count' (of grains)");
  if (!sized || !counted) table.required("solid_fraction", packing.solid_fraction);
  if (!counted) packing.count = count_for(table, scene, grains, packing);
}

/// Of grains whose sizes a file gives: none is as wide as the period, by the widest of the shapes that it may get.
void check_sizes(const std::string& file, const GrainFile& found, const Scene& scene, const Grains& grains) {
  double extent = 0, slenderness = 0;  // of a grain of scale 1, m; over the diameter of the circle of its area
  for (const auto& [index, share] : scene.shape_shares(grains)) {
    const ShapeSpec& shape = scene.shapes[static_cast<std::size_t>(index)];
    extent = std::max(extent, extent_of(shape));
    slenderness = std::max(slenderness, extent_of(shape) / equivalent_diameter(shape));
  }
  for (std::size_t i = 0; i < found.lines.size(); ++i) {
    const double widest = found.scales.empty() ? found.diameters[i] * slenderness : found.scales[i] * extent;
    if (widest >= scene.shortest_period())
      fail_at_line(file, found.lines[i],
                   fmt::format("the extent of the grain is {:.6g} m; allowed: less than the period, {:.6g} m", widest,
                               scene.shortest_period()));
  }
}

/// So far away that gaps between grains have no digits left.
void check_places(const std::string& file, const GrainFile& found, const Scene& scene, const Grains& grains) {
  constexpr double farthest = 1e9;                          // leaves 1e-7 of a size
  double extent = std::numeric_limits<double>::infinity();  // of a grain of scale 1, m
  for (const auto& [index, share] : scene.shape_shares(grains))
    extent = std::min(extent, extent_of(scene.shapes[static_cast<std::size_t>(index)]));
  for (std::size_t i = 0; i < found.lines.size(); ++i) {
    const double size = !found.diameters.empty() ? found.diameters[i]
                        : !found.scales.empty()  ? found.scales[i] * extent
                                                 : extent;
    const double away = found.positions[i].cwiseAbs().maxCoeff();
    if (away > farthest * size)
      fail_at_line(file, found.lines[i],
                   fmt::format("the grain, {:.3g} m wide, lies {:.3g} m from the origin; allowed: at most {:g} times "
                               "its width, beyond which numbers lack the digits for its contacts",
                               size, away, farthest));
  }
}

void read_grains_of_file(TableReader& table, const Scene& scene, const Grains& grains, Packing& packing) {
  const NamedFile file = read_named_file(table);
  GrainFile found = read_grain_file(file.path, file.unit, SceneLimits::bodies);
  if (scene.is_periodic() && !(found.scales.empty() && found.diameters.empty()))
    check_sizes(file.path.string(), found, scene, grains);
  if (!found.doubt.empty()) table.value("file").source.warnings.push_back(found.doubt);
  check_places(file.path.string(), found, scene, grains);
  packing.positions = std::move(found.positions);
  packing.scales = std::move(found.scales);
  packing.diameters = std::move(found.diameters);
  packing.angles = std::move(found.angles);
}

/// Each shape once, where its points lie.
void read_in_place(TableReader& table, const Scene& scene, const Grains& grains, Packing& packing) {
  table.optional("origin", packing.origin);
  if (!grains.shapes.empty())
    table.fail("kind", "each shape is there once, so that 'shapes' with their shares say nothing; give 'shape'");
  for (const auto& [index, share] : scene.shape_shares(grains)) {
    const ShapeSpec& shape = scene.shapes[static_cast<std::size_t>(index)];
    if (!shape.in_place)
      table.fail("kind", fmt::format("the shape '{}' says nowhere where it lies; allowed: with polygons, and files "
                                     "without 'diameter'",
                                     grains.shape));
    packing.shapes.push_back(index);
    packing.positions.push_back(packing.origin + polygon_properties(shape.points).centroid);
  }
}

void read_list(TableReader& table, SizeDistribution& size) {
  table.required("factors", size.factors);
  table.required("shares", size.shares, Count{size.factors.size()});
  double sum = 0;
  for (const double share : size.shares) sum += share;
  check_shares(table, "shares", sum);
}

}  // namespace

void check_shares(const TableReader& table, const std::string& key, double sum) {
  constexpr double rounding = 1e-9;
  if (std::abs(sum - 1) > rounding) table.fail(key, fmt::format("the shares sum to {}; allowed: 1", sum));
}

SizeDistribution read_size(TableReader table) {
  using Kind = SizeDistribution::Kind;
  SizeDistribution size;
  table.required("distribution", size.kind);
  if (size.kind == Kind::list) {
    read_list(table, size);
  } else {
    table.required("low", size.low);
    table.required("high", size.high, Range{.low = size.low, .low_open = true});
  }
  if (size.kind == Kind::normal || size.kind == Kind::lognormal) {
    table.required(size.kind == Kind::normal ? "mean" : "median", size.centre,
                   Range{.low = size.low, .high = size.high});
    table.required("deviation", size.deviation);
  }
  table.finish();
  return size;
}

Packing read_packing(TableReader table, const Scene& scene, const Grains& grains) {
  PackingName name;
  table.required("kind", name);
  Packing packing;
  packing.kind = kind_of(name);
  if (name == PackingName::positions) {
    table.required("positions", packing.positions);
  } else if (name == PackingName::file) {
    read_grains_of_file(table, scene, grains, packing);
  } else if (name == PackingName::in_place) {
    read_in_place(table, scene, grains, packing);
  } else if (packing.kind == PackingKind::random || packing.kind == PackingKind::fourier_voronoi) {
    read_filling(table, scene, grains, packing);
  } else {
    read_lattice(table, packing);
    if (scene.period) check_fit(table, packing, *scene.period);
    if (scene.cell) check_fit_in_cell(table, packing, scene.cell->periods);
  }
  table.finish();
  return packing;
}

}  // namespace pliant
