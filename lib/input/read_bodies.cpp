#include <algorithm>

#include "geometry/sizes.hpp"
#include "input/read_tables.hpp"

namespace pliant {

namespace {

Species read_one_species(TableReader& table, const Scene& scene) {
  Species entry;
  table.required("body", entry.body);
  table.required("material", entry.material, names_of(scene.materials));
  if (entry.body == BodyKind::compliant && scene.material(entry.material).law == MaterialLaw::rigid) {
    table.fail("material", fmt::format("material '{}' has the law \"rigid\"; a compliant body needs an elastic law",
                                       entry.material));
  }
  return entry;
}

std::vector<Species> read_species(TableReader& table, const Scene& scene) {
  if (!table.has("species")) {
    if (!table.has("body")) table.fail_missing("body", "'body' and 'material', or 'species' and 'seed'");
    return {read_one_species(table, scene)};
  }
  for (const char* key : {"body", "material"}) {
    if (table.has(key)) table.fail(key, "both it and 'species' are given; remove one");
  }
  std::vector<Species> species;
  double sum = 0;
  for (TableReader& part : table.tables("species")) {
    species.push_back(read_one_species(part, scene));
    part.required("share", species.back().share);
    part.finish();
    sum += species.back().share;
  }
  check_shares(table, "species", sum);
  return species;
}

bool fills_a_region(const Packing& packing) {
  return packing.kind == PackingKind::random || packing.kind == PackingKind::fourier_voronoi;
}

void read_species_order(TableReader& table, Grains& grains) {
  if (!table.has("species")) {
    if (table.has("species_order"))
      table.fail("species_order", "there is no 'species' to be put in an order; remove it");
    return;
  }
  table.optional("species_order", grains.species_order);
  if (grains.species_order == SpeciesOrder::in_turn && fills_a_region(grains.packing)) {
    table.fail("species_order",
               "this packing puts its grains at random places, which have no order; allowed: \"random\" here, "
               "\"in turn\" with packings \"hexagonal\", \"grid\", \"positions\", \"file\" and \"in place\"");
  }
}

InitialVelocity read_velocity(TableReader table, const Grains& grains) {
  InitialVelocity velocity;
  table.optional("uniform", velocity.uniform);
  table.optional("rotation", velocity.rotation);
  if (table.optional("gradient", velocity.gradient) && has_body(grains, BodyKind::rigid)) {
    table.fail("gradient", "the grains are rigid; allowed: for compliant bodies only");
  }
  table.finish();
  return velocity;
}

void read_seed(TableReader& table, const Scene& scene, Grains& grains) {
  const bool sizes = grains.size.kind != SizeDistribution::Kind::list || grains.size.factors.size() > 1;
  const bool shapes = grains.packing.shapes.empty() && scene.shape_shares(grains).size() > 1;
  const bool mixed = grains.species.size() > 1 && grains.species_order == SpeciesOrder::random;
  const bool random =
      mixed || !grains.angle || sizes || fills_a_region(grains.packing) || shapes || !grains.cells.empty();
  if (random) table.required("seed", grains.seed);
  if (!random && table.has("seed"))
    table.fail(
        "seed",
        "nothing is random here; remove it (species in random order, shapes, sizes, cells, a packing or a random "
        "angle use it)");
}

void read_angle(TableReader& table, Grains& grains) {
  const bool given = table.optional("angle", grains.angle);
  if (given && !grains.packing.shapes.empty())
    table.fail("angle", "the grains are in place as their points are; remove it");
  if (given && !grains.packing.angles.empty())
    table.fail("angle", "both it and the column angle of the packing's file are given; remove one");
  if (grains.packing.kind != PackingKind::fourier_voronoi) return;
  if (given) table.fail("angle", "the packing turns each grain as its cell wants it; remove it");
  grains.angle = std::nullopt;
}

/// A number of equal cells, or their relative areas.
void read_cells(TableReader& table, Grains& grains) {
  if (table.has("cells") && table.value("cells").node.is_array()) {
    table.optional("cells", grains.cells);
    return;
  }
  std::optional<int> count;
  if (table.optional("cells", count)) grains.cells.assign(static_cast<std::size_t>(*count), 1.0);
}

void check_size(const TableReader& table, const Grains& grains, const Scene& scene) {
  const std::int64_t count = grains.packing.grain_count();
  std::int64_t bodies = grains.body_count(), most_nodes = 0;
  for (const auto& [index, share] : scene.shape_shares(grains)) {
    const ShapeSpec& shape = scene.shapes[static_cast<std::size_t>(index)];
    const double extent = largest_size(grains.size) * extent_of(shape);
    if (scene.is_periodic() && extent >= scene.shortest_period()) {
      table.fail(grains.shapes.empty() ? "shape" : "shapes",
                 fmt::format("the extent of '{}' is {} m; allowed: less than the period, {} m", shape.name, extent,
                             scene.shortest_period()));
    }
    if (!shape.descriptors.empty() && grains.packing.kind != PackingKind::fourier_voronoi) {
      table.fail("shape", fmt::format("'{}' has variants = \"each\"; allowed: with packings \"fourier-voronoi\" only, "
                                      "as each grain is fitted to its cell",
                                      shape.name));
    }
    most_nodes = std::max<std::int64_t>(most_nodes, shape.nodes.value_or(0));
  }
  for (const Grains& others : scene.grains) bodies += others.body_count();
  if (bodies > SceneLimits::bodies) {
    table.fail("packing", fmt::format("{} bodies in the scene; allowed: at most {}", bodies, SceneLimits::bodies));
  }
  const std::int64_t nodes = has_body(grains, BodyKind::compliant) ? most_nodes * count : 0;
  if (nodes > SceneLimits::field_nodes) {
    table.fail("packing", fmt::format("{} field nodes; allowed: at most {}", nodes, SceneLimits::field_nodes));
  }
}

/// Names that grains can be made of: shapes and families of variants.
std::vector<std::string> shape_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const ShapeSpec& shape : scene.shapes) {
    if (!shape.family.empty() && (names.empty() || names.back() != shape.family)) names.push_back(shape.family);
    if (shape.family.empty()) names.push_back(shape.name);
  }
  return names;
}

void read_grain_shapes(TableReader& table, const Scene& scene, Grains& grains) {
  const std::vector<std::string> known = shape_names(scene);
  if (!table.has("shapes")) return table.required("shape", grains.shape, known);
  if (table.has("shape")) table.fail("shape", "both it and 'shapes' are given; remove one");
  double sum = 0;
  for (TableReader& part : table.tables("shapes")) {
    ShapeShare& entry = grains.shapes.emplace_back();
    part.required("shape", entry.shape, known);
    part.required("share", entry.share);
    part.finish();
    sum += entry.share;
  }
  check_shares(table, "shapes", sum);
}

}  // namespace

bool has_body(const Grains& grains, BodyKind kind) {
  return std::any_of(grains.species.begin(), grains.species.end(),
                     [&](const Species& entry) { return entry.body == kind; });
}

/// A stress that falls with the strain localises in one row of points unless a rate spreads it: the mesh then decides.
void check_softening(TableReader& table, const Material& material) {
  if (material.viscoplastic_time > 0) return;
  if (material.hardening < 0)
    table.fail("hardening", fmt::format("{} Pa: a material that softens localises in a band as thin as the mesh; "
                                        "allowed: at least 0 Pa{}",
                                        material.hardening,
                                        material.law == MaterialLaw::von_mises ? ", or 'viscoplastic_time' > 0" : ""));
  if (material.saturation > 0 && material.saturation < material.yield)
    table.fail("saturation", fmt::format("{} Pa: a material that softens localises in a band as thin as the mesh; "
                                         "allowed: at least 'yield', {} Pa, or 'viscoplastic_time' > 0",
                                         material.saturation, material.yield));
}

void read_von_mises(TableReader& table, Material& material) {
  table.optional("taylor_quinney", material.taylor_quinney);
  table.required("yield", material.yield);
  if (material.yield > material.young / 3)
    table.fail("yield",
               fmt::format("{} Pa; allowed: at most a third of 'young', {} Pa", material.yield, material.young / 3));
  table.optional("hardening", material.hardening);
  if (table.optional("saturation", material.saturation))
    table.required("saturation_rate", material.saturation_rate);
  else if (table.has("saturation_rate"))
    table.fail("saturation_rate", "there is no 'saturation' to be reached; remove it");
  table.optional("viscoplastic_time", material.viscoplastic_time);
  check_softening(table, material);
}

void read_drucker_prager(TableReader& table, Material& material) {
  table.optional("taylor_quinney", material.taylor_quinney);
  table.required("cohesion", material.cohesion);
  table.required("friction_angle", material.friction_angle);
  table.optional("dilatancy_angle", material.dilatancy_angle);
  if (material.dilatancy_angle > material.friction_angle)
    table.fail("dilatancy_angle", fmt::format("{} rad would make energy; allowed: at most 'friction_angle', {} rad",
                                              material.dilatancy_angle, material.friction_angle));
  table.optional("hardening", material.hardening);
  check_softening(table, material);
}

Material read_material(TableReader table, const std::string& name) {
  if (name == "all") table.fail("a material cannot be called 'all': contacts use that word for all materials");
  Material material;
  material.name = name;
  table.required("law", material.law);
  table.required("density", material.density);
  if (material.law != MaterialLaw::rigid) {
    table.required("young", material.young);
    table.required("poisson", material.poisson);
    if (material.law == MaterialLaw::neo_hookean_maxwell) {
      table.required("branch_modulus", material.branch_modulus);
      table.required("relaxation_time", material.relaxation_time);
    }
    if (material.law == MaterialLaw::von_mises) read_von_mises(table, material);
    if (material.law == MaterialLaw::drucker_prager) read_drucker_prager(table, material);
    table.optional("viscosity", material.viscosity);
  }
  table.optional("heat_capacity", material.heat_capacity);
  table.optional("mass_damping", material.mass_damping);
  table.finish();
  return material;
}

Grains read_grains(TableReader table, const Scene& scene) {
  Grains grains;
  grains.where = table.place();
  grains.name = default_grains_name(scene.grains.size() + 1);
  table.optional("name", grains.name);
  read_grain_shapes(table, scene, grains);
  if (table.has("size")) grains.size = read_size(table.optional_table("size"));
  grains.packing = read_packing(table.required_table("packing"), scene, grains);
  if (table.has("size") && !grains.packing.shapes.empty())
    table.fail("size", "the grains are in place as their points are; remove it");
  if (table.has("size") && !(grains.packing.scales.empty() && grains.packing.diameters.empty()))
    table.fail("size", "both it and the sizes of the packing's file are given; remove one");
  grains.species = read_species(table, scene);
  read_species_order(table, grains);
  read_angle(table, grains);
  read_cells(table, grains);
  read_seed(table, scene, grains);
  if (table.has("velocity")) grains.velocity = read_velocity(table.optional_table("velocity"), grains);
  check_size(table, grains, scene);
  table.finish();
  return grains;
}

}  // namespace pliant
