#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/curves.hpp"
#include "scene/polygon_rules.hpp"
#include "scene/read_tables.hpp"

namespace pliant {

namespace {

const Choice<BodyKind> body_kinds{{{"compliant", BodyKind::compliant}, {"rigid", BodyKind::rigid}}};
constexpr std::size_t most_polygon_points = 10'000;

void read_polygon(TableReader& table, ShapeSpec& shape) {
  table.required("points", shape.points, List<Vector>{{"m"}, 3, most_polygon_points});
  const std::string defect = polygon_defect(shape.points);
  if (!defect.empty()) table.fail("points", defect + "; allowed: a closed outline that does not cross or touch itself");
  if (signed_area(shape.points) < 0) std::reverse(shape.points.begin(), shape.points.end());
}

/// Reads one kind of shape by the name it has in scene files.
void read_outline(TableReader& table, ShapeSpec& shape) {
  enum class Name { disc, polygon, regular, ellipse, fourier } name;
  table.required("kind", name,
                 Choice<Name>{{{"disc", Name::disc},
                               {"polygon", Name::polygon},
                               {"regular", Name::regular},
                               {"ellipse", Name::ellipse},
                               {"fourier", Name::fourier}}});
  shape.kind = name == Name::disc                               ? ShapeKind::disc
               : name == Name::polygon || name == Name::regular ? ShapeKind::polygon
                                                                : ShapeKind::curve;
  if (name == Name::polygon) return read_polygon(table, shape);
  if (name == Name::ellipse) {
    double width = 0, height = 0;
    table.required("width", width, Quantity{"m", positive});
    table.required("height", height, Quantity{"m", positive});
    shape.points = ellipse(width, height);
    return;
  }
  table.required("diameter", shape.diameter, Quantity{"m", positive});
  if (name == Name::regular) {
    int sides = 0;
    table.required("sides", sides, Integer{3, most_polygon_points});
    shape.points = regular_polygon(sides, shape.diameter);
  }
  if (name == Name::fourier) {
    std::vector<double> descriptors;
    std::int64_t seed = 1;
    table.required("descriptors", descriptors, List<Quantity>{{"1", Range{.low = 0, .high = 1}}});
    table.optional("seed", seed, Integer{0, std::numeric_limits<std::int32_t>::max()});
    shape.points = fourier_grain(shape.diameter, descriptors, seed);
    if (shape.points.empty())
      table.fail("descriptors", "the radius is not positive all round; allowed: descriptors whose sum is below 1");
  }
}

double extent(const ShapeSpec& shape) {
  return shape.kind == ShapeKind::disc ? shape.diameter : largest_extent(shape.points);
}

/// Area of a shape, m2.
double area(const ShapeSpec& shape) {
  return shape.kind == ShapeKind::disc ? std::numbers::pi / 4 * shape.diameter * shape.diameter
                                       : signed_area(shape.points);
}

void read_nodes(TableReader& table, ShapeSpec& shape) {
  if (table.has("nodes") && table.has("spacing")) table.fail("spacing", "both it and 'nodes' are given; remove one");
  if (!table.has("nodes") && !table.has("spacing")) table.fail_missing("nodes", "'nodes' (a number) or 'spacing' (m)");
  const auto fewest = shape.kind == ShapeKind::polygon ? static_cast<std::int64_t>(shape.points.size()) : 6;
  table.optional("nodes", shape.nodes, Integer{7, SceneLimits::nodes_per_shape});
  table.optional("outline_nodes", shape.outline_nodes, Integer{fewest, SceneLimits::nodes_per_shape});
  if (!table.optional("spacing", shape.spacing, Quantity{"m", positive})) return;
  const double largest = extent(shape) / 2;
  if (*shape.spacing > largest)
    table.value("spacing").reject(fmt::format("at most half of the shape's extent, {} m", largest));
  // Interior nodes lie about hexagonally: one node an area of sqrt(3)/2 spacing^2.
  const double nodes = area(shape) / (std::sqrt(3.0) / 2 * *shape.spacing * *shape.spacing);
  if (nodes <= static_cast<double>(SceneLimits::nodes_per_shape)) return;
  table.fail("spacing", fmt::format("about {:.3g} nodes in the shape; allowed: at most {}, so a larger spacing", nodes,
                                    SceneLimits::nodes_per_shape));
}

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

Packing read_packing(TableReader table, const Scene& scene) {
  Packing packing;
  table.required(
      "kind", packing.kind,
      Choice<PackingKind>{
          {{"hexagonal", PackingKind::hexagonal}, {"grid", PackingKind::grid}, {"positions", PackingKind::positions}}});
  if (packing.kind == PackingKind::positions) {
    table.required("positions", packing.positions, List<Vector>{{"m"}, 1, SceneLimits::bodies});
  } else {
    read_lattice(table, packing);
    if (scene.period) check_fit(table, packing, *scene.period);
  }
  table.finish();
  return packing;
}

MixEntry read_mix_entry(TableReader& table, const Scene& scene) {
  MixEntry entry;
  table.required("body", entry.body, body_kinds);
  table.required("material", entry.material, OneOf{"material", names_of(scene.materials)});
  if (entry.body == BodyKind::compliant && scene.material(entry.material).law == MaterialLaw::rigid) {
    table.fail("material", fmt::format("material '{}' has the law \"rigid\"; a compliant body needs an elastic law",
                                       entry.material));
  }
  return entry;
}

std::vector<MixEntry> read_mix(TableReader& table, const Scene& scene) {
  if (!table.has("mix")) {
    if (!table.has("body")) table.fail_missing("body", "'body' and 'material', or 'mix' and 'seed'");
    return {read_mix_entry(table, scene)};
  }
  for (const char* key : {"body", "material"}) {
    if (table.has(key)) table.fail(key, "both it and 'mix' are given; remove one");
  }
  std::vector<MixEntry> mix;
  double sum = 0;
  for (TableReader& part : table.tables("mix")) {
    mix.push_back(read_mix_entry(part, scene));
    part.required("share", mix.back().share, Quantity{"1", Range{.low = 0, .high = 1, .low_open = true}});
    part.finish();
    sum += mix.back().share;
  }
  constexpr double rounding = 1e-9;
  if (std::abs(sum - 1) > rounding) table.fail("mix", fmt::format("the shares sum to {}; allowed: 1", sum));
  return mix;
}

InitialVelocity read_velocity(TableReader table, const Grains& grains) {
  InitialVelocity velocity;
  table.optional("uniform", velocity.uniform, Vector{"m/s"});
  table.optional("rotation", velocity.rotation, Quantity{"rad/s"});
  if (table.optional("gradient", velocity.gradient, Matrix{"1/s"}) && has_body(grains, BodyKind::rigid)) {
    table.fail("gradient", "the grains are rigid; allowed: for compliant bodies only");
  }
  table.finish();
  return velocity;
}

void read_seed(TableReader& table, Grains& grains) {
  const bool random = grains.mix.size() > 1 || !grains.angle;
  const Integer seed{0, std::numeric_limits<std::int64_t>::max()};
  if (random) table.required("seed", grains.seed, seed);
  if (!random && table.has("seed"))
    table.fail("seed", "nothing is random here; remove it (a mix or a random angle uses it)");
}

void check_size(const TableReader& table, const Grains& grains, const Scene& scene) {
  const ShapeSpec& shape = scene.shape(grains.shape);
  if (scene.period && extent(shape) >= *scene.period) {
    table.fail("shape", fmt::format("the extent of '{}' is {} m; allowed: less than the period, {} m", shape.name,
                                    extent(shape), *scene.period));
  }
  std::int64_t bodies = body_count(grains);
  for (const Grains& others : scene.grains) bodies += body_count(others);
  if (bodies > SceneLimits::bodies) {
    table.fail("packing", fmt::format("{} bodies in the scene; allowed: at most {}", bodies, SceneLimits::bodies));
  }
  const std::int64_t nodes = has_body(grains, BodyKind::compliant) ? shape.nodes.value_or(0) * body_count(grains) : 0;
  if (nodes > SceneLimits::field_nodes) {
    table.fail("packing", fmt::format("{} field nodes; allowed: at most {}", nodes, SceneLimits::field_nodes));
  }
}

}  // namespace

std::int64_t body_count(const Grains& grains) {
  const Packing& packing = grains.packing;
  return packing.kind == PackingKind::positions ? static_cast<std::int64_t>(packing.positions.size())
                                                : std::int64_t{packing.columns} * packing.rows;
}

bool has_body(const Grains& grains, BodyKind kind) {
  return std::any_of(grains.mix.begin(), grains.mix.end(), [&](const MixEntry& entry) { return entry.body == kind; });
}

Material read_material(TableReader table, const std::string& name) {
  if (name == "all") table.fail("a material cannot be called 'all': contacts use that word for all materials");
  Material material;
  material.name = name;
  table.required("law", material.law,
                 Choice<MaterialLaw>{{{"neo-hookean", MaterialLaw::neo_hookean},
                                      {"neo-hookean-quadratic", MaterialLaw::neo_hookean_quadratic},
                                      {"melody", MaterialLaw::melody},
                                      {"rigid", MaterialLaw::rigid}}});
  table.required("density", material.density, Quantity{"kg/m3", positive});
  if (material.law != MaterialLaw::rigid) {
    table.required("young", material.young, Quantity{"Pa", positive});
    table.required("poisson", material.poisson, Quantity{"1", Range{.low = 0, .high = 0.5, .high_open = true}});
  }
  table.finish();
  return material;
}

ShapeSpec read_shape(TableReader table, const std::string& name) {
  ShapeSpec shape;
  shape.name = name;
  read_outline(table, shape);
  read_nodes(table, shape);
  table.finish();
  return shape;
}

Grains read_grains(TableReader table, const Scene& scene) {
  Grains grains;
  const std::size_t number = scene.grains.size() + 1;
  grains.name = number == 1 ? "grains" : fmt::format("grains{}", number);
  table.optional("name", grains.name, Identifier{});
  table.required("shape", grains.shape, OneOf{"shape", names_of(scene.shapes)});
  grains.packing = read_packing(table.required_table("packing"), scene);
  grains.mix = read_mix(table, scene);
  table.optional("angle", grains.angle, QuantityOr{"random", {"rad"}});
  read_seed(table, grains);
  if (table.has("velocity")) grains.velocity = read_velocity(table.required_table("velocity"), grains);
  check_size(table, grains, scene);
  table.finish();
  return grains;
}

}  // namespace pliant
