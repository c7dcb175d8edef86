#include "scene/quantities.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pliant {

namespace {

using Node = ProbeQuantity::Node;
using Of = ProbeQuantity::Of;
using Where = ProbeQuantity::Where;
using Names = std::vector<std::string>;
using Reductions = std::vector<Reduction>;

const Reductions mean_first{Reduction::mean, Reduction::min, Reduction::max};
const Reductions sum_first{Reduction::sum, Reduction::mean, Reduction::min, Reduction::max};

/// Names of the components of a vector, with a unit.
Names vector_columns(const std::string& name, const std::string& unit) {
  return {fmt::format("{}_x [{}]", name, unit), fmt::format("{}_y [{}]", name, unit)};
}

Names with_unit(const Names& names, const std::string& unit) {
  Names columns;
  for (const std::string& name : names) columns.push_back(fmt::format("{} [{}]", name, unit));
  return columns;
}

ProbeQuantity whole(const std::string& name, const Names& columns, const std::string& meaning) {
  return {.name = name, .columns = columns, .of = Of::whole, .reduced = {}, .reductions = {}, .meaning = meaning};
}

/// A value for each body, or at a node of one.
ProbeQuantity by_body(const std::string& name, const Names& columns, Of of, const Reductions& reductions, Node node,
                      const std::string& meaning) {
  return {.name = name,
          .columns = columns,
          .of = of,
          .reduced = "bodies",
          .reductions = reductions,
          .node = node,
          .meaning = meaning};
}

/// A value at each integration point of compliant bodies.
ProbeQuantity by_point(const std::string& name, const Names& columns, const std::string& meaning) {
  return {.name = name,
          .columns = columns,
          .of = Of::compliant,
          .reduced = "points",
          .reductions = mean_first,
          .node = Node::field,
          .meaning = meaning};
}

/// A value at each outline node in touch.
ProbeQuantity by_contact(const std::string& name, const std::string& unit, const std::string& meaning) {
  return {.name = name,
          .columns = {fmt::format("{} [{}]", name, unit)},
          .of = Of::any,
          .reduced = "contacts",
          .reductions = mean_first,
          .node = Node::outline,
          .with = true,
          .meaning = meaning};
}

std::vector<ProbeQuantity> motions() {
  return {
      by_body("position", {"position_x [m]", "position_y [m]", "angle [rad]"}, Of::any, mean_first, Node::field,
              "centre of mass, not wrapped into the period; the angle of rigid bodies"),
      by_body("displacement", vector_columns("displacement", "m"), Of::any, mean_first, Node::field, "from the start"),
      by_body("velocity", {"velocity_x [m/s]", "velocity_y [m/s]", "angular_velocity [rad/s]"}, Of::any, mean_first,
              Node::field, "of the centre of mass; the angular velocity of rigid bodies"),
      by_body("acceleration", vector_columns("acceleration", "m/s2"), Of::any, mean_first, Node::field,
              "total force over mass"),
      by_body("rotation", {"rotation [rad]", "rotation_rate [rad/s]"}, Of::any, mean_first, Node::none,
              "from the start; of a compliant body the best fit to its positions, in (-pi, pi], and the angular "
              "momentum of its nodes' masses over their moment of inertia"),
      by_body("diameter", vector_columns("diameter", "m"), Of::grains, mean_first, Node::none,
              "extents of the outline"),
      by_body("area", {"area [m2]"}, Of::grains, sum_first, Node::none, "inside the current outline"),
  };
}

std::vector<ProbeQuantity> forces() {
  return {
      by_body("force", vector_columns("force", "N/m"), Of::any, sum_first, Node::outline,
              "resultant contact force on the selected body, normal and tangential parts"),
      {.name = "friction_factor",
       .columns = {"friction_factor [-]"},
       .of = Of::walls,
       .reduced = {},
       .reductions = {},
       .meaning = "contact force on the wall: force_x over the magnitude of force_y; the sign is that of force_x"},
      by_body("internal_force", vector_columns("internal_force", "N/m"), Of::compliant, sum_first, Node::field,
              "of stresses on the degrees of freedom; over a whole body it vanishes to rounding"),
      by_body("body_force", vector_columns("body_force", "N/m"), Of::any, sum_first, Node::none, "of gravity"),
      by_body("applied_force", vector_columns("applied_force", "N/m"), Of::any, sum_first, Node::none,
              "of the histories of force and pressure, with what bears the weight of a wall under a pressure, and of "
              "soft supports"),
      by_body("damping_force", vector_columns("damping_force", "N/m"), Of::any, sum_first, Node::none,
              "of mass_damping and of dashpots beside loads"),
      by_body("reaction_force", vector_columns("reaction_force", "N/m"), Of::any, sum_first, Node::none,
              "that an imposed motion needs"),
      by_body("total_force", vector_columns("total_force", "N/m"), Of::any, sum_first, Node::none,
              "of all origins: mass times acceleration"),
  };
}

std::vector<ProbeQuantity> stresses() {
  const Names stress = with_unit({"stress_xx", "stress_yy", "stress_xy", "stress_zz", "principal_1", "principal_2",
                                  "von_mises", "tresca", "pressure"},
                                 "Pa");
  const Names contact_stress =
      with_unit({"stress_xx", "stress_xy", "stress_yx", "stress_yy", "principal_1", "principal_2", "pressure"}, "Pa");
  return {
      by_point(
          "stress", stress,
          "Cauchy stress, tension positive; the mean is over current volume, and the columns from principal_1 on are "
          "then those of the mean tensor; principal stresses in the plane, principal_1 the larger; von Mises, Tresca "
          "and pressure with stress_zz"),
      by_point("von_mises", {"von_mises [Pa]"}, "the local von Mises stress: its mean is not that of the mean tensor"),
      by_point("jacobian", {"jacobian [-]"}, "current over reference volume"),
      by_point("strain", with_unit({"strain_xx", "strain_yy", "strain_xy"}, "-"),
               "Green-Lagrange strain in the axes of the start; the mean is over reference volume"),
      by_point("plastic_strain", {"plastic_strain [-]"},
               "equivalent plastic strain, 0 for laws without; the mean is over reference volume"),
      {.name = "contact_stress",
       .columns = contact_stress,
       .of = Of::grains,
       .reduced = {},
       .reductions = {},
       .where = Where::region_allowed,
       .meaning =
           "Love-Weber: sum over contacts of force times branch from the grain's centre, over the area of the "
           "grains, or of the region for grains whose centre is in it; tension positive; principal stresses of its "
           "symmetric part, pressure -(xx + yy)/2"},
  };
}

std::vector<ProbeQuantity> cells() {
  std::vector<ProbeQuantity> all{
      whole(
          "cell_stress",
          with_unit({"stress_xx", "stress_xy", "stress_yx", "stress_yy", "kinetic_xx", "kinetic_xy", "kinetic_yx",
                     "kinetic_yy", "pressure"},
                    "Pa"),
          "of a cell with two periods, tension positive: Love-Weber over the area of the cell, with the kinetic part, "
          "which is given alone as well; pressure -(xx + yy)/2"),
      whole("cell_gradient",
            {"gradient_xx [-]", "gradient_xy [-]", "gradient_yx [-]", "gradient_yy [-]", "cell_area [m2]"},
            "deformation gradient of a cell with two periods, from the periods of the scene on, and its area")};
  for (ProbeQuantity& quantity : all) quantity.in_cell = true;
  return all;
}

std::vector<ProbeQuantity> energies() {
  return {
      whole("energy",
            {"kinetic [J/m]", "strain [J/m]", "contact [J/m]", "boundary [J/m]", "dissipated [J/m]",
             "external_work [J/m]", "balance_error [-]", "momentum_error [-]"},
            "of the whole scene, with the errors of its balances"),
      whole("works",
            with_unit({"work_of_loads", "work_of_gravity", "dissipated_by_contact", "dissipated_by_damping",
                       "dissipated_by_plasticity", "dissipated_by_bonds"},
                      "J/m"),
            "external work of loads and imposed motions, and of gravity, and dissipation, by their origin since the "
            "start"),
      by_body("temperature_rise", {"temperature_rise [K]"}, Of::any, mean_first, Node::none,
              "of bodies since the start, from their dissipation, without conduction; NaN without `heat_capacity`"),
      by_body("kinetic_energy", {"kinetic_energy [J/m]"}, Of::any, sum_first, Node::none, "of bodies"),
      by_body("strain_energy", {"strain_energy [J/m]"}, Of::compliant, sum_first, Node::none, "of compliant bodies"),
  };
}

std::vector<ProbeQuantity> contacts() {
  return {
      by_contact("contact_gap", "m", "negative: penetration"),
      by_contact("contact_slip", "m",
                 "elongation of the tangential contact spring; not the accumulated sliding distance"),
      by_contact("contact_pressure", "Pa",
                 "of the law, without dashpots and energy correction; means are weighted by length"),
      by_contact("contact_shear", "Pa",
                 "of the law, on the node, positive to the left of the normal of the body touched"),
      {.name = "contacts",
       .columns = {"contact_pairs [-]", "contact_nodes [-]"},
       .of = Of::any,
       .reduced = {},
       .reductions = {},
       .with = true,
       .meaning = "pairs of bodies in touch, and outline nodes of the selected bodies in touch"},
      {.name = "contact_length",
       .columns = {"contact_length [m]"},
       .of = Of::any,
       .reduced = "bodies",
       .reductions = sum_first,
       .with = true,
       .meaning = "tributary lengths of a body's outline nodes in touch, each node once"},
  };
}

std::vector<ProbeQuantity> bonds() {
  return {
      whole("bonds", with_unit({"whole_bonds", "softening_bonds", "torn_bonds"}, "-"),
            "numbers of bonded segments by their damage"),
      whole(
          "fragments", {"fragments [-]", "largest_mass [kg/m]", "d10 [m]", "d50 [m]", "d90 [m]", "aspect_ratio [-]"},
          "grains and cells that bonds hold together; diameters below which 10, 50 and 90 % of the mass lie; mass mean "
          "of the ratio of principal radii of gyration"),
  };
}

std::vector<ProbeQuantity> packing() {
  return {
      {.name = "coordination",
       .columns = with_unit({"coordination", "coordination_without_rattlers", "rattlers"}, "-"),
       .of = Of::grains,
       .reduced = {},
       .reductions = {},
       .meaning = "mean number of bodies that a grain touches, walls included; the same over the grains that touch two "
                  "or more; share of the others"},
      {.name = "solid_fraction",
       .columns = {"solid_fraction [-]"},
       .of = Of::grains,
       .reduced = {},
       .reductions = {},
       .where = Where::region_needed,
       .meaning = "area inside the grains' outlines over that of the region; overlaps count twice; in a cell with two "
                  "periods the region may be left out"},
      {.name = "fabric",
       .columns = {"fabric_xx [-]", "fabric_xy [-]", "fabric_yy [-]", "anisotropy [-]", "direction [rad]"},
       .of = Of::any,
       .reduced = {},
       .reductions = {},
       .with = true,
       .meaning =
           "mean of n (x) n over pairs in touch; difference of its principal values, 0 to 1, and direction of the "
           "larger, in (-pi/2, pi/2]"},
  };
}

FrameField field(FrameField::Grid grid, FrameField::Centre centre, const std::string& name, const std::string& unit,
                 const std::string& meaning, int components = 1, bool constant = false) {
  return {grid, centre, name, unit, components, constant, meaning};
}

std::vector<FrameField> all_fields() {
  constexpr auto bodies = FrameField::Grid::bodies, outlines = FrameField::Grid::outlines;
  constexpr auto point = FrameField::Centre::point, cell = FrameField::Centre::cell;
  std::vector<FrameField> all{
      field(bodies, point, "displacement", "m", "from the start", 2),
      field(bodies, point, "velocity", "m/s", "of the material", 2),
      field(bodies, point, "acceleration", "m/s2", "total force over mass", 2),
      field(bodies, cell, "von_mises", "Pa", "von Mises stress"),
      field(bodies, cell, "tresca", "Pa", "largest difference of principal stresses, stress_zz among them"),
      field(bodies, cell, "pressure", "Pa", "minus a third of the trace of the stress"),
      field(bodies, cell, "jacobian", "-", "current over reference volume"),
      field(bodies, cell, "strain_energy_density", "J/m3", "per reference volume"),
      field(bodies, cell, "plastic_strain", "-", "equivalent plastic strain, 0 for laws without"),
      field(bodies, cell, "temperature_rise", "K", "since the start; NaN without `heat_capacity`"),
      field(bodies, cell, "contact_count", "-", "bodies that the grain touches"),
      field(bodies, cell, "fragment", "-", "number of the first body of the fragment, -1 for walls"),
      field(bodies, cell, "material", "-", "number of the material in the scene file, from 0", 1, true),
      field(bodies, cell, "scale", "-", "size over that of the shape", 1, true),
      field(outlines, point, "contact_pressure", "Pa", "normal part of the contact force over the tributary length"),
      field(outlines, point, "contact_shear", "Pa", "its tangential part, along the outline"),
      field(outlines, point, "bond_damage", "-", "mean over the node's bonds, 0 whole to 1 torn; NaN without"),
      field(outlines, point, "contact_gap", "m", "least of the node's contacts; NaN without"),
      field(outlines, point, "contact_slip", "m",
            "largest elongation of the tangential springs of its contacts, with its sign; 0 without"),
  };
  for (const char* component : {"xx", "yy", "xy", "zz"})
    all.push_back(field(bodies, cell, fmt::format("stress_{}", component), "Pa", "Cauchy stress, tension positive"));
  for (const char* number : {"1", "2"})
    all.push_back(field(bodies, cell, fmt::format("principal_stress_{}", number), "Pa", "in the plane, 1 the larger"));
  for (const char* component : {"xx", "yy", "xy"})
    all.push_back(field(bodies, cell, fmt::format("strain_{}", component), "-",
                        "Green-Lagrange strain in the axes of the start"));
  return all;
}

template <class Named>
const Named& named(const std::vector<Named>& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
}

std::string subject(Of of) {
  switch (of) {
    case Of::whole:
      return "";
    case Of::walls:
      return "wall";
    case Of::grains:
      return "grains";
    case Of::compliant:
      return "compliant grains";
    case Of::any:
      break;
  }
  return "wall, grains";
}

std::string settings(const ProbeQuantity& quantity) {
  std::vector<std::string> all;
  if (!quantity.reductions.empty()) {
    Names names;
    for (Reduction reduction : quantity.reductions) names.push_back(reduction_name(reduction));
    all.push_back(fmt::format("`reduce` over {}: {}", quantity.reduced, fmt::join(names, ", ")));
  }
  if (quantity.node != Node::none) all.push_back(quantity.node == Node::field ? "`node`" : "`node` of the outline");
  if (quantity.with) all.push_back("`with`");
  if (quantity.where != Where::nowhere)
    all.push_back(quantity.where == Where::region_needed ? "`between` or `box`, needed" : "`between` or `box`");
  return fmt::format("{}", fmt::join(all, "; "));
}

}  // namespace

const std::vector<ProbeQuantity>& probe_quantities() {
  static const std::vector<ProbeQuantity> all = [] {
    std::vector<ProbeQuantity> result;
    for (const auto& part : {motions(), forces(), stresses(), cells(), energies(), contacts(), bonds(), packing()})
      result.insert(result.end(), part.begin(), part.end());
    return result;
  }();
  return all;
}

const ProbeQuantity& probe_quantity(const std::string& name) { return named(probe_quantities(), name); }

const std::vector<FrameField>& frame_fields() {
  static const std::vector<FrameField> all = all_fields();
  return all;
}

const FrameField& frame_field(const std::string& name) { return named(frame_fields(), name); }

std::string reduction_name(Reduction reduction) {
  constexpr const char* names[] = {"mean", "sum", "min", "max"};
  return names[static_cast<int>(reduction)];
}

std::string probe_table() {
  std::string text = "| quantity | columns | of | settings | meaning |\n|---|---|---|---|---|\n";
  for (const ProbeQuantity& q : probe_quantities())
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", q.name, fmt::join(q.columns, ", "), subject(q.of),
                        settings(q), q.meaning);
  return text;
}

std::string field_table() {
  std::string text = "| field | unit | grid | at | meaning |\n|---|---|---|---|---|\n";
  for (const FrameField& f : frame_fields())
    text += fmt::format(
        "| `{}` | {} | {} | {}{} | {} |\n", f.name, f.unit, f.grid == FrameField::Grid::bodies ? "bodies" : "outlines",
        f.centre == FrameField::Centre::point ? "points" : "cells", f.constant ? ", written once" : "", f.meaning);
  return text;
}

}  // namespace pliant
