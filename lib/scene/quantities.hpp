#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace pliant {

/// What a probe may measure: everything but the function, which results/probes/probe_functions.cpp holds under the same
/// name.
struct ProbeQuantity {
  enum class Of { whole, walls, grains, compliant, any };  ///< `any`: walls and grains

  std::string name;
  std::vector<std::string> columns;  ///< with units: "force_x [N/m]"
  Of of = Of::any;
  std::string reduced;                ///< what `reduce` goes over: "bodies", "points", "contacts"; empty: nothing
  std::vector<Reduction> reductions;  ///< the first is the default
  /// Nodes of one body that it may be taken at: of the outline, or all field nodes (rigid bodies: of the outline).
  enum class Node { none, outline, field } node = Node::none;
  bool with = false;  ///< may be restricted to contacts with some partners
  enum class Where { nowhere, region_allowed, region_needed } where = Where::nowhere;
  bool in_cell = false;  ///< of a cell with two periods alone
  std::string meaning;   ///< for docs/probes.md
};

const std::vector<ProbeQuantity>& probe_quantities();
/// The quantity of that name; the name is known to be one.
const ProbeQuantity& probe_quantity(const std::string& name);

/// What a frame may hold: results/frame_fields.cpp has the functions.
struct FrameField {
  enum class Grid { bodies, outlines } grid = Grid::bodies;
  enum class Centre { point, cell } centre = Centre::cell;
  std::string name;
  std::string unit;
  int components = 1;     ///< 2: a vector, written with a zero third component
  bool constant = false;  ///< written once
  std::string meaning;
};

const std::vector<FrameField>& frame_fields();
const FrameField& frame_field(const std::string& name);

std::string reduction_name(Reduction reduction);

/// The two tables of docs/probes.md, in Markdown.
std::string probe_table();
std::string field_table();

}  // namespace pliant
