#include <limits>

#include "input/scene_keys.hpp"

namespace pliant {
namespace {

/// Spacings: beyond, contact sees into bodies further than outlines resolve them, and the stable step only shrinks.
constexpr double most_skin = 4;

std::vector<SceneTable> boundary_tables() {
  const Choice held =
      choice<AxisCondition::Mode>({{"fixed", AxisCondition::Mode::fixed}, {"free", AxisCondition::Mode::free}});
  const SceneKey from{"from", Quantity{"s", non_negative}, derived("start of the run"), "Time from which it acts"};
  const SceneKey until{"until", Quantity{"s", positive}, derived("end of the run"), "Time until which it acts"};
  const SceneKey velocity{"velocity", HistoryOf{{"m/s"}}, "none", "Prescribed velocity"};
  const SceneKey force{"force", HistoryOf{{"N/m"}}, "none", "Force on the grain, in addition to its weight",
                       "rigid grains"};
  const SceneKey damping{"damping", Quantity{"Pa s", non_negative}, "0 Pa s", "Coefficient of a dashpot to the ground",
                         "force"};
  const SceneKey displacement{"displacement", HistoryOf{{"m"}}, "none", "Displacement of the anchors since the start",
                              "compliant grains"};
  const char *support = "soft supports: `x` or `y` of compliant grains", *outline = "pressures and soft supports";
  const auto outline_part = [&](SceneKey row) {
    row.with = outline;
    return row;
  };
  return {
      {"[[boundary]]",
       {
           {"of", Text{}, required, R"(Set of grains, or one of them as in "grains 17")"},
           {"x", held, R"("free")", "Motion along x"},
           {"x", one_table, "none", "Motion or load along x"},
           {"y", held, R"("free")", "Motion along y"},
           {"y", one_table, "none", "Motion or load along y"},
           {"angle", held, R"("free")", "Rotation", "rigid grains"},
           {"angle", one_table, "none", "Rotation or moment", "rigid grains"},
           {"pressure", HistoryOf{{"Pa"}}, required_if("without `x`, `y` and `angle`"),
            "Pressure on the outline, inwards"},
           {"mode", choice<bool>({{"following", true}, {"oriented", false}}), R"("following")",
            "Pressure on the current outline, or as a dead load", "pressure"},
           {"direction", Vector{"1"}, "none", "Direction of the dead load; otherwise the inward initial normal",
            R"(mode = "oriented")"},
           {"stiffness", QuantityOr{"auto", {"Pa/m", positive}}, R"("auto")", "Stiffness of the support", support},
           {"damping", Quantity{"Pa s/m", non_negative}, "0 Pa s/m", "Damping coefficient of the support", support},
           {"part", one_table, "none", "Part of the outline; otherwise all of it", outline},
           outline_part(from),
           outline_part(until),
       }},
      {"x of [[boundary]]", {velocity, force, displacement, damping, from, until}},
      {"y of [[boundary]]", {velocity, force, displacement, damping, from, until}},
      {"angle of [[boundary]]",
       {
           {"velocity", HistoryOf{{"rad/s"}}, "none", "Prescribed angular velocity"},
           {"moment", HistoryOf{{"N"}}, "none", "Moment per thickness on the grain"},
           {"damping", Quantity{"N s", non_negative}, "0 N s", "Coefficient of a rotational dashpot to the ground",
            "moment"},
           from,
           until,
       }},
      {"part of [[boundary]]",
       {
           {"angles", List<Quantity>{{"rad"}, 2, 2}, "none", "Directions from the centre, counter-clockwise"},
           {"box", Corners{}, "none", "Corners of a box"},
           {"side",
            choice<OutlineSide>({{"left", OutlineSide::left},
                                 {"right", OutlineSide::right},
                                 {"bottom", OutlineSide::bottom},
                                 {"top", OutlineSide::top}}),
            "none", "Side that the outward normals face within 45 degrees"},
       }},
  };
}

SceneTable rule_table() {
  const char *cohesive = R"(law = "cohesive")", *coulomb = R"(law = "mohr-coulomb")";
  const QuantityOr stiffness{"auto", {"Pa/m", positive}};
  const Quantity stress{"Pa", non_negative};
  return {
      "[[contacts]]",
      {
          {"between", List<OneOf>{{"material, grains or wall", {}}, 2, 2}, required, "Both sides of the pairs"},
          {"between", OneOf{"word", {"all"}}, required, "All pairs"},
          {"law",
           choice<ContactLawKind>({{"frictionless", ContactLawKind::frictionless},
                                   {"mohr-coulomb", ContactLawKind::mohr_coulomb},
                                   {"cohesive", ContactLawKind::cohesive}}),
           required, "Contact law"},
          {"stiffness", stiffness, R"("auto")", "Normal stiffness (penalty)"},
          {"shear_stiffness", stiffness, R"("auto")", "Tangential stiffness; auto: the normal one",
           R"(law = "mohr-coulomb", "cohesive")"},
          {"friction", Friction{}, required, "Coefficient of friction", coulomb},
          {"cohesion", stress, "0 Pa", "Cohesion: shear strength without pressure", coulomb},
          {"tension", stress, "0 Pa", "Tensile strength (cut-off)", coulomb},
          {"smoothing", Quantity{"1", {.low = 0, .high = 1}}, "0",
           "Range of the quadratic onset of pressure, over the outline spacing", "laws without tension"},
          {"restitution", Quantity{"1", {.low = 0.01, .high = 1}}, "none",
           "Coefficient of restitution of rigid pairs; otherwise no dashpot", "laws without tension"},
          {"pull", Flag{}, "false", "Tension by the dashpot of the restitution", "restitution"},
          {"strength", Quantity{"Pa", positive}, required, "Tensile strength", cohesive},
          {"range", QuantityOr{"auto", {"m", positive}}, R"("auto")", "Gap at which the tension vanishes", cohesive},
          {"shear_strength", QuantityOr{"auto", stress}, R"("auto")", "Shear strength; auto: the tensile one",
           cohesive},
      }};
}

SceneTable bond_table() {
  const QuantityOr stiffness{"auto", {"Pa/m", positive}};
  const Quantity positive_energy{"J/m2", positive};
  return {"[[bonds]]",
          {
              {"between", List<OneOf>{{"material, grains or wall", {}}, 2, 2}, required, "Both sides of the pairs"},
              {"between", OneOf{"word", {"all"}}, required, "All pairs"},
              {"from", Quantity{"s", non_negative}, "0 s", "Time when the bonds are made"},
              {"gap", Quantity{"m", non_negative}, "0 m",
               "Widest gap that cement bridges; 0: only surfaces that touch are bonded"},
              {"strength", Quantity{"Pa", positive}, required, "Tensile strength"},
              {"cohesion", QuantityOr{"auto", {"Pa", positive}}, R"("auto")",
               "Shear strength without pressure; auto: the tensile one"},
              {"friction", QuantityOr{"auto", {"1", non_negative}}, R"("auto")",
               "Increase of the shear strength with pressure; auto: the friction of contact"},
              {"fracture_energy", positive_energy, required, "Energy of a new crack in tension"},
              {"shear_fracture_energy", QuantityOr{"auto", positive_energy}, R"("auto")",
               "Energy of a new crack in shear; auto: that in tension"},
              {"stiffness", stiffness, R"("auto")", "Normal stiffness; auto: that of contact"},
              {"shear_stiffness", stiffness, R"("auto")", "Tangential stiffness; auto: the normal one"},
              {"fatigue_rate", Quantity{"Pa-1", non_negative}, "0 Pa-1",
               "Damage per tensile stress above the threshold, at the strength"},
              {"shear_fatigue_rate", Quantity{"Pa-1", non_negative}, derived("`fatigue_rate`"),
               "Damage per shear stress above the threshold, at the strength"},
              {"fatigue_threshold", Quantity{"Pa", non_negative}, required_if("with a rate", "0 Pa"),
               "Stress above which each loading damages, below `strength`"},
              {"weibull_modulus", Quantity{"1", positive}, "none",
               "Modulus of Weibull's distribution of strengths, by pairs of bodies; otherwise all are equal"},
              {"seed", Integer{0, std::numeric_limits<std::int32_t>::max()}, required, "Seed of the strengths",
               "weibull_modulus"},
          }};
}

}  // namespace

std::vector<SceneTable> load_and_contact_tables() {
  std::vector<SceneTable> all = boundary_tables();
  all.push_back(
      {"[contact]",
       {
           {"skin", Quantity{"1", {.low = 0, .high = most_skin, .low_open = true}}, "0.5",
            "Skin of the Verlet list, over the finest outline spacing"},
           {"quadrature",
            choice<ContactQuadrature>({{"auto", ContactQuadrature::automatic},
                                       {"nodes", ContactQuadrature::nodes},
                                       {"segments", ContactQuadrature::segments}}),
            R"("auto")", "Quadrature of contact tractions: at nodes, or over segments"},
           {"length",
            choice<ContactLength>({{"reference", ContactLength::reference}, {"current", ContactLength::current}}),
            R"("reference")", "Length on which contact pressures act"},
           {"refresh", QuantityOr{"safe", {"s", positive}}, R"("safe")",
            "Time between rebuilds of the Verlet list, with its unit"},
           {"refresh", Integer{1, 1'000'000}, "none", "Number of steps between rebuilds of the Verlet list"},
           {"self_contact", Flag{}, "false", "Contact of compliant grains with themselves"},
           {"energy_consistent", Flag{}, "true", "Correction of the energy error of contact",
            R"(the integrator "verlet")"},
       }});
  all.push_back(rule_table());
  all.push_back(bond_table());
  return all;
}

}  // namespace pliant
