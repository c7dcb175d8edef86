#include "discretisation/table.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.hpp"
#include "discretisation/mass.hpp"
#include "discretisation/recipes.hpp"

namespace pliant {
namespace {

constexpr int largest_support_mls = 14, largest_support_mls_gauss = 25, least_support = 7;

void require_support(const DiscretisationSettings& settings) {
  const bool consistent = settings.recipe == Recipe::mls;
  const int largest = consistent ? largest_support_mls : largest_support_mls_gauss;
  if (settings.support < least_support || settings.support > largest)
    throw InputError(fmt::format("discretisation: support = {} nodes; allowed for `{}`: {} to {} (8 to 10 advised)",
                                 settings.support, consistent ? "mls" : "mls-gauss", least_support, largest));
  if (settings.support > largest_support_mls)
    spdlog::warn("discretisation: support = {} nodes; above 12, row-sum mass creates modes that move no material",
                 settings.support);
}

std::vector<double> nearest_distances(const Points& nodes) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (j != i) least = std::min(least, (nodes[j] - nodes[i]).squaredNorm());
    distances.push_back(std::sqrt(least));
  }
  return distances;
}

Points outline_of(const FieldMesh& mesh) { return {mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count}; }

// Recipes work in mean node distances, so that conditioning does not depend on the user's units.
FieldMesh nondimensional(FieldMesh mesh, double length) {
  for (Vec2& x : mesh.nodes) x /= length;
  return mesh;
}

void give_dimensions(Discretisation& result, double length) {
  for (double& w : result.table.weight) w *= length * length;
  for (double& m : result.unit_mass) m *= length * length;
  for (Vec2& b : result.table.gradient) b /= length;
}

}  // namespace

Discretisation discretise(const FieldMesh& mesh, const DiscretisationSettings& settings) {
  require_support(settings);
  const double area = polygon_properties(outline_of(mesh)).area;
  const double length = std::sqrt(area / static_cast<double>(mesh.nodes.size()));
  const FieldMesh scaled = nondimensional(mesh, length);
  const MlsNodes nodes = make_mls_nodes(scaled.nodes, settings.support);
  Discretisation result;
  result.mesh = mesh;
  result.outline_rows = mls_rows(nodes, outline_of(scaled));
  result.node_rows = mls_rows(nodes, scaled.nodes);
  result.unit_mass = lumped_mass(scaled, nodes);
  result.nodal_distance = nearest_distances(mesh.nodes);
  RecipeResult recipe = settings.recipe == Recipe::mls ? build_mls(scaled, nodes, result.outline_rows)
                                                       : build_mls_gauss(scaled, nodes, settings.gauss_points);
  result.table = std::move(recipe.table);
  const auto& values = result.node_rows.value;
  result.min_shape_value = std::min(recipe.min_shape_value, *std::min_element(values.begin(), values.end()));
  result.completeness_residual = recipe.completeness_residual;
  give_dimensions(result, length);
  return result;
}

}  // namespace pliant
