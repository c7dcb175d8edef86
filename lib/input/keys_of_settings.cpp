#include "input/scene_keys.hpp"
#include "scene/quantities.hpp"

namespace pliant {
namespace {

SceneTable cell_table() {
  return {
      "cell of [domain]",
      {
          {"xx", HistoryOf{{"1"}}, "none", "Deformation gradient of the cell: stretch along x; otherwise 1"},
          {"yy", HistoryOf{{"1"}}, "none", "Stretch along y; otherwise 1"},
          {"xy", HistoryOf{{"1"}}, "none", "Shear: displacement along x over y; otherwise 0"},
          {"yx", HistoryOf{{"1"}}, "none", "Shear: displacement along y over x; otherwise 0"},
          {"stress_xx", HistoryOf{{"Pa"}}, "none", "Stress of the cell in place of `xx`, tension positive"},
          {"stress_yy", HistoryOf{{"Pa"}}, "none", "Stress of the cell in place of `yy`, tension positive"},
          {"stress_xy", HistoryOf{{"Pa"}}, "none", "Shear stress of the cell in place of `xy`"},
          {"inertia", Quantity{"1", positive}, "1", "Inertia of the cell that stress moves, over that of its matter"},
          {"damping", Quantity{"1", {.low = 0, .high = 1, .high_open = true}}, "0.8",
           "Share of the force on the cell that acts against its motion"},
      }};
}

}  // namespace

std::vector<SceneTable> setting_tables() {
  const Range share{.low = 0, .high = 1, .low_open = true};
  const Quantity pure_share{"1", share};
  const char *verlet = R"(integrator = "verlet")", *doubling = R"(integrator = "step-doubling")";
  return {
      {top_table,
       {
           {"title", Text{}, derived("name of the file"), "Title of the scene in summaries"},
           {"domain", one_table, "none", "Periods and gravity"},
           {"time", one_table, required, "End of the run and time integration"},
           {"discretisation", one_table, "none", "Shape functions and mass matrix of compliant grains"},
           {"materials", named_tables, required, "Materials of grains and walls"},
           {"shapes", named_tables, required, "Shapes of grains, with their nodes"},
           {"grains", array_of_tables, required, "Sets of grains"},
           {"walls", array_of_tables, "none", "Walls across the period"},
           {"boundary", array_of_tables, "none", "Loads, motions and supports of grains"},
           {"contact", one_table, "none", "Settings of contact for the whole scene"},
           {"contacts", array_of_tables, required_if("where bodies can meet", "none"),
            "Contact laws between pairs of bodies"},
           {"bonds", array_of_tables, "none", "Bonds between bodies, or between the cells of breakable grains"},
           {"probes", array_of_tables, "none", "Measurements over time"},
           {"frames", one_table, "none", "Fields over all bodies at equal times"},
           {"start", one_table, "none", "State of an earlier run as initial state"},
           {"checkpoint", one_table, "none", "Checkpoints to resume a run from"},
       }},
      {"[domain]",
       {
           {"period", Quantity{"m", positive}, "none", "Length of the periodic domain along x"},
           {"periods", List<Quantity>{{"m", positive}, 2, 2}, "none",
            "Lengths of a cell with two periods, along x and y, at the start"},
           {"cell", one_table, "none", "Deformation of the cell with two periods", "periods"},
           {"gravity", Vector{"m/s2"}, "zero", "Acceleration of gravity"},
           {"gravity", VectorHistory{"m/s2"}, "none", "History of the acceleration of gravity"},
       }},
      cell_table(),
      {"[time]",
       {
           {"end", Quantity{"s", positive}, required, "End of the simulated time"},
           {"integrator",
            choice<Integrator>({{"verlet", Integrator::verlet}, {"step-doubling", Integrator::step_doubling}}),
            R"("verlet")", "Scheme of time integration"},
           {"stop_at_outputs", Flag{}, "false", "Time steps that end at output times"},
           {"tolerance", pure_share, "0.01", "Error estimate allowed per step, over the nodal distance", verlet},
           {"safety", pure_share, "0.8", "Ratio of the time step to the stability bound", verlet},
           {"target", pure_share, "0.0001", "Error that the step-size controller aims at", doubling},
           {"alpha", Quantity{"1", {.low = 1}}, "2", "Ratio of error to target above which a step is rejected",
            doubling},
           {"beta", pure_share, "0.2", "Exponent of the step-size controller", doubling},
       }},
      {"[discretisation]",
       {
           {"method",
            choice<DiscretisationMethod>({{"mls", DiscretisationMethod::mls},
                                          {"mls-gauss", DiscretisationMethod::mls_gauss},
                                          {"t3", DiscretisationMethod::t3},
                                          {"es-t3", DiscretisationMethod::es_t3},
                                          {"rpim", DiscretisationMethod::rpim}}),
            R"("mls")", "Shape functions and their quadrature", "", "recipe"},
           {"mass", choice<Mass>({{"lumped", Mass::lumped}, {"corrected", Mass::corrected}}), R"("lumped")",
            "Mass matrix: lumped by row sums, or with a correction"},
           {"mass_scaling", Quantity{"1", {.low = 1, .high = 10}}, "1",
            "Selective mass scaling of outline nodes; 1: none", R"(mass = "lumped")"},
           {"support", Integer{7, 14}, "8", "Rank of the neighbour whose distance is the nodal support radius",
            R"(method = "mls")"},
           {"support", Integer{7, 25}, "8", "Rank of the neighbour whose distance is the nodal support radius",
            R"(method = "mls-gauss", "rpim")"},
           {"gauss_points", Integer{1, 6}, "3", "Gauss points per triangle: 1, 3 or 6",
            R"(method = "mls-gauss", "rpim")"},
       }},
      {"[start]", {{"from", Text{}, required, "Folder or state file of the earlier run"}}},
      {"[checkpoint]",
       {{"period", QuantityOr{"never", {"s", positive}}, "600 s", "Wall-clock time between checkpoints"}}},
  };
}

std::vector<SceneTable> output_tables() {
  std::vector<std::string> quantities, fields;
  for (const ProbeQuantity& one : probe_quantities()) quantities.push_back(one.name);
  for (const FrameField& one : frame_fields()) fields.push_back(one.name);
  return {
      {"[[probes]]",
       {
           {"name", Identifier{}, required, "Name of the probe, before its columns"},
           {"quantity", OneOf{"quantity", quantities}, required, "Quantity that is measured"},
           {"of", OneOf{"wall or grains", {}}, required,
            R"(Wall or grains measured, such as "floor", "grains 17", "compliant" or "all")", "quantities of bodies"},
           {"period", Quantity{"s", positive}, required, "Time between samples"},
           {"reduce",
            choice<Reduction>(
                {{"mean", Reduction::mean}, {"sum", Reduction::sum}, {"min", Reduction::min}, {"max", Reduction::max}}),
            "none", "Reduction over bodies, points or contacts; otherwise the quantity's own",
            "quantities with several samples"},
           {"node", Integer{0, SceneLimits::nodes_per_shape}, "none", "Node of the one body that `of` names",
            "quantities of nodes"},
           {"with", OneOf{"wall or grains", {}}, "none", "Partners of the contacts; otherwise all",
            "quantities of contacts"},
           {"between", List<OneOf>{{"wall", {}}, 2, 2}, "none", "Lower and upper wall of the region",
            "quantities of regions"},
           {"box", Corners{}, "none", "Corners of the region", "quantities of regions"},
       }},
      {"[frames]",
       {
           {"period", Quantity{"s", positive}, required, "Time between frames"},
           {"fields", List<OneOf>{{"field", fields}, 0}, "none", "Fields that each frame holds"},
           {"contacts", Flag{}, "false", "Contact network in each frame"},
       }},
  };
}

}  // namespace pliant
