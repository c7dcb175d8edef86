#include "bodies/short_edges.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace pliant {
namespace {

/// Edge length over the spacing that gives a message. The number of steps of a block becomes 1.05 times as large by an
/// edge of 0.1 with `mls`, 1.3 by one of 0.01; 3.5 and 26 with `es-t3`.
constexpr double short_edge = 0.1;

}  // namespace

std::optional<std::string> of_short_edges(const Model& model) {
  double least = short_edge;
  const Body* of = nullptr;
  for (const Body& body : model.bodies) {
    if (body.kind != BodyKind::compliant) continue;
    const OutlineShape& outline = model.outlines[body.outline];
    const double shortest = *std::min_element(outline.segment_length.begin(), outline.segment_length.end());
    if (shortest / outline.spacing < least) least = shortest / outline.spacing, of = &body;
  }
  if (!of) return {};
  return fmt::format(
      "shape '{}' has an edge of {:.2g} m, {:.2g} of its spacing: its two nodes share the mass of one: steps get "
      "shorter, triangles flat, and spurious slow modes appear; leave one of its ends out",
      model.scene.shapes[of->shape].name, least * model.outlines[of->outline].spacing, least);
}

}  // namespace pliant
