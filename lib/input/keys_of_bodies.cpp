#include <limits>
#include <numbers>

#include "input/scene_keys.hpp"

namespace pliant {
namespace {

const Quantity length{"m", positive};
const Quantity pure_number{"1", positive};
const Quantity share_of_grains{"1", {.low = 0, .high = 1, .low_open = true}};
const Choice body_kinds = choice<BodyKind>({{"compliant", BodyKind::compliant}, {"rigid", BodyKind::rigid}});
const OneOf some_material{"material", {}}, some_shape{"shape", {}};

SceneTable material_table() {
  const char *elastic = R"(law != "rigid")", *branch = R"(law = "neo-hookean-maxwell")",
             *plastic = R"(law = "von-mises")", *frictional = R"(law = "drucker-prager")",
             *hardens = R"(law = "von-mises", "drucker-prager")";
  return {
      "[materials.NAME]",
      {
          {"law",
           choice<MaterialLaw>({{"neo-hookean", MaterialLaw::neo_hookean},
                                {"neo-hookean-quadratic", MaterialLaw::neo_hookean_quadratic},
                                {"melody", MaterialLaw::melody},
                                {"linear-elastic", MaterialLaw::linear_elastic},
                                {"neo-hookean-maxwell", MaterialLaw::neo_hookean_maxwell},
                                {"von-mises", MaterialLaw::von_mises},
                                {"drucker-prager", MaterialLaw::drucker_prager},
                                {"rigid", MaterialLaw::rigid}}),
           required, "Constitutive law"},
          {"density", Quantity{"kg/m3", positive}, required, "Mass density of the undeformed material"},
          {"young", Quantity{"Pa", positive}, required, "Young's modulus at small strains", elastic},
          {"poisson", Quantity{"1", {.low = 0, .high = 0.5, .high_open = true}}, required,
           "Poisson's ratio at small strains", elastic},
          {"viscosity", Quantity{"Pa s", non_negative}, "0 Pa s", "Kelvin-Voigt viscosity", elastic},
          {"branch_modulus", Quantity{"Pa", positive}, required, "Shear modulus of the Maxwell branch", branch},
          {"relaxation_time", Quantity{"s", positive}, required, "Relaxation time of the Maxwell branch", branch},
          {"yield", Quantity{"Pa", positive}, required, "Yield stress, at most `young`/3", plastic},
          {"cohesion", Quantity{"Pa", non_negative}, required, "Cohesion of Mohr and Coulomb", frictional},
          {"friction_angle", Quantity{"rad", {.low = 0, .high = 1.4, .low_open = true}}, required,
           "Friction angle of Mohr and Coulomb", frictional},
          {"dilatancy_angle", Quantity{"rad", non_negative}, "0 rad", "Dilatancy angle, at most `friction_angle`",
           frictional},
          {"hardening", Quantity{"Pa"}, "0 Pa", "Slope of yield stress or cohesion by the equivalent plastic strain",
           hardens},
          {"saturation", Quantity{"Pa", positive}, "none", "Yield stress to which Voce's hardening tends", plastic},
          {"saturation_rate", Quantity{"1", positive}, required,
           "Rate of Voce's hardening by the equivalent plastic strain", "saturation"},
          {"viscoplastic_time", Quantity{"s", non_negative}, "0 s", "Time of Perzyna's rate dependence", plastic},
          {"heat_capacity", Quantity{"J/(kg K)", positive}, "none",
           "Specific heat capacity, if temperatures are followed"},
          {"taylor_quinney", Quantity{"1", {.low = 0, .high = 1}}, "0.9", "Share of the plastic loss that becomes heat",
           hardens},
          {"mass_damping", Quantity{"1/s", non_negative}, "0 1/s", "Mass-proportional damping coefficient of grains"},
      }};
}

SceneTable shape_table() {
  const char *file = R"(kind = "file")", *fourier = R"(kind = "fourier")", *ellipse = R"(kind = "ellipse")";
  return {
      "[shapes.NAME]",
      {
          {"kind",
           choice<ShapeName>({{"disc", ShapeName::disc},
                              {"polygon", ShapeName::polygon},
                              {"regular", ShapeName::regular},
                              {"ellipse", ShapeName::ellipse},
                              {"fourier", ShapeName::fourier},
                              {"file", ShapeName::file}}),
           required, "Kind of outline"},
          {"diameter", length, required, "Diameter of the circle of the same area", R"(kind = "disc", "fourier")"},
          {"diameter", length, required, "Diameter of the circumscribed circle", R"(kind = "regular")"},
          {"diameter", length, "none", "Diameter of the circle of the same area; otherwise the file's own size", file},
          {"points", List<Vector>{{"m"}, 3, SceneLimits::polygon_points}, required, "Corners of the polygon",
           R"(kind = "polygon")"},
          {"sides", Integer{3, SceneLimits::polygon_points}, required, "Number of sides", R"(kind = "regular")"},
          {"rounding", length, "none", "Radius of the arcs that replace corners", R"(kind = "polygon", "regular")"},
          {"width", length, required, "Axis of the ellipse along x", ellipse},
          {"height", length, required, "Axis of the ellipse along y", ellipse},
          {"file", Text{}, required, "File of the outline, relative to the scene", file},
          {"unit", Text{}, "none", "Unit of length of the file", file},
          {"parts", Text{}, "none", R"(Parts of a mesh file: "all", "merged", or a name)", file},
          {"outline", choice<ShapeKind>({{"polygon", ShapeKind::polygon}, {"curve", ShapeKind::curve}}), R"("polygon")",
           "Points of the file as corners, or on a smooth curve", file},
          {"descriptors", List<Quantity>{{"1", {.low = 0, .high = 1}}}, required,
           "Amplitudes of the Fourier modes of the radius", fourier},
          {"seed", Integer{0, std::numeric_limits<std::int32_t>::max()}, "1", "Seed of the phases", fourier},
          {"variants", Integer{1, SceneLimits::variants}, "none", "Number of shapes, from consecutive seeds", fourier},
          {"variants", choice<Variant>({{"each", Variant::each}}), "none", "Shape of its own for each Voronoi cell",
           fourier},
          {"nodes", Integer{7, SceneLimits::nodes_per_shape}, "none", "Number of field nodes, unless `spacing`"},
          {"spacing", length, "none", "Nodal distance, unless `nodes`"},
          {"outline_nodes", Integer{3, SceneLimits::nodes_per_shape}, "none",
           "Number of outline nodes, at least the corners or 6; otherwise from `nodes` or `spacing`"},
      }};
}

SceneTable packing_table() {
  const char *lattice = R"(kind = "hexagonal", "grid")", *filling = R"(kind = "random", "fourier-voronoi")";
  const Integer count{1, SceneLimits::bodies};
  const Quantity fraction{"1", {.low = 0, .high = 1, .low_open = true, .high_open = true}};
  return {"packing of [[grains]]",
          {
              {"kind",
               choice<PackingName>({{"hexagonal", PackingName::hexagonal},
                                    {"grid", PackingName::grid},
                                    {"positions", PackingName::positions},
                                    {"file", PackingName::file},
                                    {"in place", PackingName::in_place},
                                    {"random", PackingName::random},
                                    {"fourier-voronoi", PackingName::fourier_voronoi}}),
               required, "Arrangement of the grains"},
              {"columns", count, required, "Number of columns", lattice},
              {"rows", count, required, "Number of rows", lattice},
              {"pitch", length, required, "Distance of columns", lattice},
              {"row_pitch", length, derived("`pitch`; hexagonal: 2/sqrt(3) `pitch`"), "Distance of rows", lattice},
              {"origin", Vector{"m"}, "zero", "Centre of the first grain, or shift of shapes in place",
               R"(kind = "hexagonal", "grid", "in place")"},
              {"positions", List<Vector>{{"m"}, 1, SceneLimits::bodies}, required, "Centres of the grains",
               R"(kind = "positions")"},
              {"file", Text{}, required, "File with positions, and perhaps angles and sizes", R"(kind = "file")"},
              {"unit", Text{}, "none", "Unit of length of the file", R"(kind = "file")"},
              {"bottom", Quantity{"m"}, required, "Lower edge of the filled region",
               "random, fourier-voronoi, without `periods`"},
              {"top", Quantity{"m"}, required, "Upper edge of the filled region, above `bottom`",
               "random, fourier-voronoi, without `periods`"},
              {"left", Quantity{"m"}, required, "Left edge of the filled region", "random, without a period"},
              {"right", Quantity{"m"}, required, "Right edge of the filled region, beyond `left`",
               "random, without a period"},
              {"count", count, "none", "Number of grains", filling},
              {"solid_fraction", fraction, required, "Area fraction of the grains in the region",
               R"(kind = "fourier-voronoi")"},
              {"solid_fraction", fraction, required_if("without `count`"), "Area fraction of the grains in the region",
               "random, without `count`"},
          }};
}

SceneTable size_table() {
  using Kind = SizeDistribution::Kind;
  const char *limited = R"(distribution != "list")", *list = R"(distribution = "list")";
  return {"size of [[grains]]",
          {
              {"distribution",
               choice<Kind>({{"list", Kind::list},
                             {"uniform", Kind::uniform},
                             {"normal", Kind::normal},
                             {"lognormal", Kind::lognormal}}),
               required, "Distribution of sizes, relative to the shape"},
              {"factors", List<Quantity>{pure_number}, required, "Sizes", list},
              {"shares", List<Quantity>{share_of_grains}, required, "Number fractions of the sizes, of sum 1", list},
              {"low", pure_number, required, "Smallest size, where the distribution is cut off", limited},
              {"high", pure_number, required, "Largest size, where the distribution is cut off", limited},
              {"mean", pure_number, required, "Mean size before the cut-off, from `low` to `high`",
               R"(distribution = "normal")"},
              {"median", pure_number, required, "Median size before the cut-off, from `low` to `high`",
               R"(distribution = "lognormal")"},
              {"deviation", pure_number, required, "Standard deviation of the size, or of its logarithm if lognormal",
               R"(distribution = "normal", "lognormal")"},
          }};
}

std::vector<SceneTable> grain_tables() {
  return {
      {"[[grains]]",
       {
           {"name", Identifier{}, derived(R"("grains", "grains2", ...)"), "Name of the set"},
           {"shape", some_shape, required_if("without `shapes`"), "Shape of the grains"},
           {"shapes", array_of_tables, "none", "Shapes and their number fractions"},
           {"size", one_table, "none", "Size distribution"},
           {"packing", one_table, required, "Initial positions"},
           {"body", body_kinds, required_if("without `species`"), "Mechanics of the grains: compliant or rigid"},
           {"material", some_material, required_if("without `species`"), "Material of the grains"},
           {"species", array_of_tables, "none", "Bodies and materials with their number fractions", "", "mix"},
           {"species_order",
            choice<SpeciesOrder>({{"random", SpeciesOrder::random}, {"in turn", SpeciesOrder::in_turn}}), R"("random")",
            "Assignment of `species` to the grains", "species", "mix_order"},
           {"angle", QuantityOr{"random", {"rad"}}, "0 rad", "Initial orientation"},
           {"seed", Integer{0, std::numeric_limits<std::int64_t>::max()}, required_if("with anything random"),
            "Seed of all random choices of the set"},
           {"velocity", one_table, "none", "Initial velocity"},
           {"cells", Integer{2, SceneLimits::cells}, "none", "Number of cells that each grain is cut into"},
           {"cells", List<Quantity>{{"1", positive}, 2, SceneLimits::cells}, "none",
            "Relative areas of the cells that each grain is cut into"},
       }},
      {"shapes of [[grains]]",
       {
           {"shape", some_shape, required, "Shape"},
           {"share", share_of_grains, required, "Number fraction of grains of this shape; all sum to 1"},
       }},
      {"species of [[grains]]",
       {
           {"body", body_kinds, required, "Mechanics of these grains: compliant or rigid"},
           {"material", some_material, required, "Material of these grains"},
           {"share", Quantity{"1", {.low = 0, .high = 1}}, required, "Number fraction of these grains; all sum to 1"},
       }},
      {"velocity of [[grains]]",
       {
           {"uniform", Vector{"m/s"}, "zero", "Velocity of the centre"},
           {"rotation", Quantity{"rad/s"}, "0 rad/s", "Angular velocity, counter-clockwise"},
           {"gradient", Matrix{"1/s"}, "zero", "Velocity gradient of compliant grains"},
       }},
  };
}

std::vector<SceneTable> wall_tables() {
  const Choice held =
      choice<AxisCondition::Mode>({{"fixed", AxisCondition::Mode::fixed}, {"free", AxisCondition::Mode::free}});
  const SceneKey from{"from", Quantity{"s", non_negative}, derived("start of the run"), "Time from which it acts"};
  const SceneKey until{"until", Quantity{"s", positive}, derived("end of the run"), "Time until which it acts"};
  const Range acute{.low = 0, .high = std::numbers::pi / 2, .low_open = true, .high_open = true};
  return {
      {"[[walls]]",
       {
           {"name", Identifier{}, required, "Name of the wall"},
           {"material", some_material, required, "Material of the wall"},
           {"solid", choice<Wall::Solid>({{"below", Wall::Solid::below}, {"above", Wall::Solid::above}}), required,
            "Side of its line on which the wall is solid"},
           {"level", Quantity{"m"}, required, "Height of the flat line, or of asperities of height 0"},
           {"spacing", length, derived("finest of the grains"), "Outline spacing"},
           {"asperities", one_table, "none", "Asperities: circular arcs of equal diameter", "", "caps"},
           {"x", held, R"("fixed")", "Motion along x"},
           {"x", one_table, "none", "Motion or load along x"},
           {"y", held, R"("fixed")", "Motion along y"},
           {"y", one_table, "none", "Motion or load along y"},
           {"thickness", Quantity{"m", non_negative},
            required_if("(> 0) unless fixed or at a given velocity for good", "0 m"),
            "Thickness that gives the mass: density x period x thickness"},
       }},
      {"asperities of [[walls]]",
       {
           {"diameter", length, required, "Diameter of the arcs"},
           {"count", Integer{1, SceneLimits::wall_nodes}, required, "Number of asperities over the period"},
           {"first", Quantity{"m"}, "0 m", "Position of the first centre along x"},
           {"heights", List<Quantity>{{"m"}}, "[0]", "Heights of the centres above `level`, cyclic"},
           {"half_angles", List<Quantity>{{"rad", acute}}, required,
            "Half-angles of the arcs about the wall's normal, cyclic"},
       }},
      {"x of [[walls]]",
       {
           {"velocity", HistoryOf{{"m/s"}}, "none", "Prescribed velocity"},
           {"force", HistoryOf{{"N/m"}}, "none", "Force on the wall, in addition to its weight"},
           {"damping", Quantity{"Pa s", non_negative}, "0 Pa s", "Coefficient of a dashpot to the ground", "force"},
           from,
           until,
       }},
      {"y of [[walls]]",
       {
           {"velocity", HistoryOf{{"m/s"}}, "none", "Prescribed velocity"},
           {"force", HistoryOf{{"N/m"}}, "none", "Force on the wall, in addition to its weight"},
           {"pressure", HistoryOf{{"Pa"}}, "none", "Pressure towards the grains, without the wall's weight"},
           {"damping", Quantity{"Pa s", non_negative}, "0 Pa s", "Coefficient of a dashpot to the ground", "force"},
           {"damping", Quantity{"Pa s/m", non_negative}, "0 Pa s/m", "Coefficient of a dashpot to the ground",
            "pressure"},
           from,
           until,
       }},
  };
}

}  // namespace

std::vector<SceneTable> body_tables() {
  std::vector<SceneTable> all{material_table(), shape_table()};
  for (const std::vector<SceneTable>& more :
       {grain_tables(), std::vector{packing_table(), size_table()}, wall_tables()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace pliant
