#include <cmath>

#include "scene/read_tables.hpp"
#include "scene/sizes.hpp"

namespace pliant {

namespace {

void read_lattice(TableReader& table, Packing& packing) {
  const Integer count{1, SceneLimits::bodies};
  table.required("columns", packing.columns, count);
  table.required("rows", packing.rows, count);
  table.required("pitch", packing.pitch, Quantity{"m", positive});
  // A hexagonal packing of columns that touch: the rows of a column lie one diameter apart.
  packing.row_pitch = packing.kind == PackingKind::hexagonal ? packing.pitch * 2 / std::sqrt(3.0) : packing.pitch;
  table.optional("row_pitch", packing.row_pitch, Quantity{"m", positive});
  table.optional("origin", packing.origin, Vector{"m"});
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

const Quantity solid_fraction{"1", Range{.low = 0, .high = 1, .low_open = true, .high_open = true}};

/// The part of the plane that grains are to fill.
void read_region(TableReader& table, const Scene& scene, Packing& packing) {
  table.required("bottom", packing.bottom, Quantity{"m"});
  table.required("top", packing.top, Quantity{"m", Range{.low = packing.bottom, .low_open = true}});
  if (scene.period) {
    packing.left = 0, packing.right = *scene.period;
    return;
  }
  if (packing.kind == PackingKind::fourier_voronoi)
    table.fail("kind", "the scene has no period, which these cells need; add [domain] period, or take \"random\"");
  table.required("left", packing.left, Quantity{"m"});
  table.required("right", packing.right, Quantity{"m", Range{.low = packing.left, .low_open = true}});
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
  const bool counted = table.optional("count", packing.count, Integer{1, SceneLimits::bodies});
  if (sized && counted && table.has("solid_fraction"))
    table.fail("solid_fraction", "both it and 'count' are given; remove one");
  if (sized && !counted && !table.has("solid_fraction"))
    table.fail_missing("solid_fraction", "'solid_fraction' (a number) or 'count' (of grains)");
  if (!sized || !counted) table.required("solid_fraction", packing.solid_fraction, solid_fraction);
  if (!counted) packing.count = count_for(table, scene, grains, packing);
}

void read_list(TableReader& table, SizeDistribution& size) {
  table.required("factors", size.factors, List<Quantity>{{"1", positive}});
  table.required("shares", size.shares, List<Quantity>{share_of_grains, size.factors.size(), size.factors.size()});
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
  table.required("distribution", size.kind,
                 Choice<Kind>{{{"list", Kind::list},
                               {"uniform", Kind::uniform},
                               {"normal", Kind::normal},
                               {"lognormal", Kind::lognormal}}});
  if (size.kind == Kind::list) {
    read_list(table, size);
  } else {
    table.required("low", size.low, Quantity{"1", positive});
    table.required("high", size.high, Quantity{"1", Range{.low = size.low, .low_open = true}});
  }
  if (size.kind == Kind::normal || size.kind == Kind::lognormal) {
    table.required(size.kind == Kind::normal ? "mean" : "median", size.centre,
                   Quantity{"1", Range{.low = size.low, .high = size.high}});
    table.required("deviation", size.deviation, Quantity{"1", positive});
  }
  table.finish();
  return size;
}

Packing read_packing(TableReader table, const Scene& scene, const Grains& grains) {
  Packing packing;
  table.required("kind", packing.kind,
                 Choice<PackingKind>{{{"hexagonal", PackingKind::hexagonal},
                                      {"grid", PackingKind::grid},
                                      {"positions", PackingKind::positions},
                                      {"random", PackingKind::random},
                                      {"fourier-voronoi", PackingKind::fourier_voronoi}}});
  if (packing.kind == PackingKind::positions) {
    table.required("positions", packing.positions, List<Vector>{{"m"}, 1, SceneLimits::bodies});
  } else if (packing.kind == PackingKind::random || packing.kind == PackingKind::fourier_voronoi) {
    read_filling(table, scene, grains, packing);
  } else {
    read_lattice(table, packing);
    if (scene.period) check_fit(table, packing, *scene.period);
  }
  table.finish();
  return packing;
}

}  // namespace pliant
