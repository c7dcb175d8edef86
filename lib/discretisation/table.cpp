#include "discretisation/table.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/errors.hpp"
#include "discretisation/mass.hpp"
#include "discretisation/methods.hpp"
#include "discretisation/mls.hpp"
#include "discretisation/rpim.hpp"
#include "geometry/polygon.hpp"

namespace pliant {
namespace {

constexpr int largest_support_mls = 14, largest_support_others = 25, least_support = 7;

MlsNodes nodes_with_supports(const FieldMesh& mesh, const DiscretisationSettings& settings) {
  const int largest = settings.method == DiscretisationMethod::mls ? largest_support_mls : largest_support_others;
  if (settings.support < least_support || settings.support > largest)
    throw InputError(
        fmt::format("discretisation: support = {} nodes; allowed for this method: {} to {} (8 to 10 advised)",
                    settings.support, least_support, largest));
  if (settings.support > largest_support_mls)
    spdlog::warn("discretisation: support = {} nodes; above 12, row-sum mass creates modes that move no material",
                 settings.support);
  return make_mls_nodes(mesh, settings.support);
}

MethodResult build(const FieldMesh& mesh, const Basis& basis, const ShapeRows& outline_rows,
                   const DiscretisationSettings& settings) {
  switch (settings.method) {
    case DiscretisationMethod::mls:
      return build_mls(mesh, basis, outline_rows);
    case DiscretisationMethod::es_t3:
      return build_es_t3(mesh);
    case DiscretisationMethod::t3:
      return build_at_gauss_points(mesh, basis, 1);
    default:
      return build_at_gauss_points(mesh, basis, settings.gauss_points);
  }
}

std::vector<double> nearest_distances(const Points& nodes) {
  const NodeGrid grid = make_node_grid(nodes);
  std::vector<double> distances;
  for (const Vec2& x : nodes) distances.push_back(std::sqrt(grid.square_distance_to_nearest(x, 1)));
  return distances;
}

Points outline_of(const FieldMesh& mesh) { return {mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count}; }

// Discretisations use mean node distances, so that conditioning does not depend on the user's units.
FieldMesh nondimensional(FieldMesh mesh, double length) {
  for (Vec2& x : mesh.nodes) x /= length;
  return mesh;
}

void give_dimensions(Discretisation& result, double length) {
  for (double& w : result.table.weight) w *= length * length;
  for (double& m : result.mass_at_unit_density) m *= length * length;
  for (Vec2& b : result.table.gradient) b /= length;
}

}  // namespace

Basis make_basis(const FieldMesh& mesh, const DiscretisationSettings& settings) {
  switch (settings.method) {
    case DiscretisationMethod::t3:
    case DiscretisationMethod::es_t3:
      return linear_triangles(mesh);
    case DiscretisationMethod::rpim:
      return radial_point_interpolation(nodes_with_supports(mesh, settings));
    default:
      return moving_least_squares(nodes_with_supports(mesh, settings));
  }
}

namespace {

Discretisation discretised(const FieldMesh& mesh, const DiscretisationSettings& settings) {
  const double area = polygon_properties(outline_of(mesh)).area;
  const double length = std::sqrt(area / static_cast<double>(mesh.nodes.size()));
  const FieldMesh scaled = nondimensional(mesh, length);
  BasisQuality quality;
  const Basis basis = watched(make_basis(scaled, settings), quality);
  Discretisation result;
  result.mesh = mesh;
  result.node_rows = rows_at_nodes(scaled, basis);
  result.outline_rows = rows_at_outline(scaled, result.node_rows);
  result.mass_at_unit_density = lumped_mass(scaled, basis);
  result.nodal_distance = nearest_distances(mesh.nodes);
  if (settings.mass_scaling > 1) {
    ScaledMass mass = scaled_mass(scaled, result.mass_at_unit_density, settings.mass_scaling);
    result.reciprocal_mass = std::move(mass.reciprocal), result.relative_mass = std::move(mass.relative);
    result.reciprocal_mass_averages = true;
  }
  if (settings.mass == Mass::corrected) {
    result.reciprocal_mass = corrected_reciprocal_mass(scaled, basis, result.mass_at_unit_density);
    result.reciprocal_mass_bound = reciprocal_mass_bound(result.reciprocal_mass, result.mass_at_unit_density);
  }
  MethodResult method = build(scaled, basis, result.outline_rows, settings);
  result.table = std::move(method.table);
  result.min_shape_value = quality.least_value;
  result.condition = quality.condition;
  result.completeness_residual = method.completeness_residual;
  give_dimensions(result, length);
  return result;
}

/// Outlines may be finer than the interior by this factor: nodes = N alone makes them 1.22 times finer.
constexpr double finer_outline = 1.25;

/// Nodes of a mesh of equilateral triangles whose outline has `outline` segments (Euler's formula).
double isotropic_nodes(const Points& polygon, double outline) {
  const double spacing = perimeter(polygon) / outline;
  return 1 + outline / 2 + polygon_properties(polygon).area / (std::sqrt(3.0) / 2 * spacing * spacing);
}

/// Advice how to give the nodes of a mesh more neighbours.
std::string more_neighbours(const FieldMesh& mesh) {
  const Points outline = outline_of(mesh);
  const int nodes = static_cast<int>(mesh.nodes.size());
  const double needed = isotropic_nodes(outline, mesh.outline_count / finer_outline);
  if (nodes >= needed) return "raise `support`";
  int fitting = mesh.outline_count;
  while (fitting > 6 && isotropic_nodes(outline, fitting / finer_outline) > nodes) --fitting;
  return fmt::format(
      "its {} outline nodes are too fine for {} nodes in all: take outline_nodes = {} or fewer, or nodes = {:.0f} or "
      "more",
      mesh.outline_count, nodes, fitting, std::ceil(needed));
}

}  // namespace

Discretisation discretise(const FieldMesh& mesh, const DiscretisationSettings& settings) {
  try {
    return discretised(mesh, settings);
  } catch (const TooFewNeighbours& error) {
    throw InputError(fmt::format("{}; {}", error.what(), more_neighbours(mesh)));
  }
}

}  // namespace pliant
