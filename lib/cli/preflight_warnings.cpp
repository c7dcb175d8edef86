#include "cli/preflight_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "bodies/short_edges.hpp"
#include "discretisation/mass.hpp"
#include "materials/with_law.hpp"

namespace pliant {
namespace {

using std::numbers::pi;

constexpr double least_excess = 1e-3;  ///< of inertia, worth a word

bool is_smooth(const Model& model, const Body& body) {
  return !body.wall && model.scene.shapes[body.shape].kind != ShapeKind::polygon;
}

/// Outline nodes of the coarsest smooth grain; nothing where all grains have straight sides.
std::optional<int> fewest_facets(const Model& model) {
  std::optional<int> fewest;
  for (const Body& body : model.bodies)
    if (const int count = model.outlines[body.outline].count;
        is_smooth(model, body) && count < fewest.value_or(count + 1))
      fewest = count;
  return fewest;
}

bool has_round_rigid_grains(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [&](const Body& body) { return body.kind == BodyKind::rigid && is_smooth(model, body); });
}

/// A facet's normal is that of the curve in its middle, and half the turn of a corner off at its ends.
std::string of_facets(int facets) {
  return fmt::format(
      "{} facets tilt the normals of a smooth outline by up to {:.2g} degrees: contacts without friction may carry "
      "{:.2g} % "
      "of their force along the surface; more outline nodes, less",
      facets, 180.0 / facets, 100 * std::tan(pi / facets));
}

std::string of_rolling(double restitution) {
  return fmt::format(
      "restitution {:g} resists rolling: its dashpots act on each node that comes in touch and leaves again; discs "
      "lost 14 "
      "to 85 % of their energy in a turn at 0.5 and 0.1 (docs/defaults.md, \"What polygons change\")",
      restitution);
}

double largest_inertia_ratio(const Model& model) {
  double largest = 1;
  for (const CompliantShape& shape : model.shapes)
    largest = std::max(largest,
                       inertia_ratio(shape.space.mesh, shape.space.mass_at_unit_density, shape.space.reciprocal_mass));
  return largest;
}

std::string of_inertia(double excess, const Scene& scene) {
  const DiscretisationSettings& space = scene.discretisation;
  return fmt::format("compliant grains have up to {:.2g} % more rotational inertia than their polygons{}", 100 * excess,
                     space.mass == Mass::corrected ? ""
                     : space.mass_scaling > 1      ? ", by lumped and scaled mass"
                     : scene.cell                  ? ", by lumped mass"
                                  : ", by lumped mass: [discretisation] mass = \"corrected\" leaves a tenth of it");
}

std::optional<double> least_restitution(const Scene& scene) {
  double least = 1;
  for (const ContactRule& rule : scene.contacts) least = std::min(least, rule.restitution.value_or(1));
  return least < 1 ? std::optional(least) : std::nullopt;
}

/// Whether linear triangles of a plastic body would lock.
bool has_locking_triangles(const Model& model) {
  return model.scene.discretisation.method == DiscretisationMethod::t3 &&
         std::any_of(model.batches.begin(), model.batches.end(), [&](const Batch& batch) {
           return with_law_type<double>(model.groups[batch.group].law,
                                        []<class Law>(std::type_identity<Law>) { return flow_keeps_volume<Law>; });
         });
}

}  // namespace

std::vector<std::string> preflight_warnings(const Model& model) {
  std::vector<std::string> all;
  if (const std::optional<int> facets = fewest_facets(model)) all.push_back(of_facets(*facets));
  if (const std::optional<double> restitution = least_restitution(model.scene);
      restitution && has_round_rigid_grains(model))
    all.push_back(of_rolling(*restitution));
  if (const double excess = largest_inertia_ratio(model) - 1; excess > least_excess)
    all.push_back(of_inertia(excess, model.scene));
  if (has_locking_triangles(model))
    all.emplace_back(
        "method \"t3\" locks where plastic flow keeps the volume: with 4 to 8 spacings across a part, forces were 2 % "
        "too high in a neck and 4 to 9 % in a bent panel (verify/plasticity); take \"mls\" or \"es-t3\"");
  if (const std::optional<std::string> edges = of_short_edges(model)) all.push_back(*edges);
  return all;
}

}  // namespace pliant
