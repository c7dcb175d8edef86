// As verify/frozen_states: the reference solver's discretisation against the engine's, on the same meshes. INDEPENDENT:
// the two share no line between mesh and table.
#include <gtest/gtest.h>

#include <Eigen/SparseCore>

#include "discretisation/table.hpp"
#include "reference/discretisation/space.hpp"
#include "reference/shapes.hpp"
#include "support/figures.hpp"

namespace pliant {
namespace {

using namespace testing;

/// Of the largest entry of each kind.
constexpr double entry_tolerance = 1e-11;

/// Largest difference of two lists of sparse rows, zeros where one has no entry.
double difference(const std::vector<reference::Row>& own, const ShapeRows& engine) {
  double largest = own.size() + 1 == engine.start.size() ? 0 : INFINITY;
  for (std::size_t k = 0; k < own.size() && largest < INFINITY; ++k) {
    std::map<int, double> rest;
    for (std::size_t i = 0; i < own[k].node.size(); ++i) rest[own[k].node[i]] += own[k].value[i];
    for (int e = engine.start[k]; e < engine.start[k + 1]; ++e) rest[engine.node[e]] -= engine.value[e];
    for (const auto& [node, value] : rest) largest = std::max(largest, std::abs(value));
  }
  return largest;
}

struct PointDifference {
  double weight = 0, gradient = 0;
};

PointDifference difference(const reference::Point& own, const IntegrationTable& engine, std::size_t g) {
  std::map<int, Vec2> rest;
  for (std::size_t i = 0; i < own.node.size(); ++i)
    rest.try_emplace(own.node[i], 0, 0).first->second += own.gradient[i];
  for (int e = engine.start[g]; e < engine.start[g + 1]; ++e)
    rest.try_emplace(engine.node[e], 0, 0).first->second -= engine.gradient[e];
  PointDifference result{std::abs(own.weight - engine.weight[g]), 0};
  for (const auto& [node, value] : rest) result.gradient = std::max(result.gradient, value.cwiseAbs().maxCoeff());
  return result;
}

/// Whether both stand for the same background triangles.
bool same_triangles(const reference::Point& own, const std::array<int, 2>& cells) {
  const std::set<int> mine(own.triangles.begin(), own.triangles.end()), theirs(cells.begin(), cells.end());
  return mine == theirs;
}

/// Largest differences over all points. The order of points is free within the same triangles: each takes the nearest
/// partner that is left.
PointDifference difference(const reference::Space& own, const IntegrationTable& engine) {
  PointDifference largest;
  std::vector<bool> taken(engine.weight.size(), false);
  for (const reference::Point& point : own.points) {
    PointDifference best{INFINITY, INFINITY};
    std::size_t chosen = 0;
    for (std::size_t g = 0; g < engine.weight.size(); ++g) {
      if (taken[g] || !same_triangles(point, engine.cells[g])) continue;
      const PointDifference here = difference(point, engine, g);
      if (here.gradient < best.gradient) best = here, chosen = g;
    }
    if (best.gradient < INFINITY) taken[chosen] = true;
    largest.weight = std::max(largest.weight, best.weight);
    largest.gradient = std::max(largest.gradient, best.gradient);
  }
  return largest;
}

/// The consistent mass that the engine's correction 2 I - D^-1 M was made of.
Eigen::SparseMatrix<double> engine_mass(const Discretisation& engine) {
  const auto nodes = static_cast<Eigen::Index>(engine.mass_at_unit_density.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < nodes; ++i) {
    entries.emplace_back(i, i, 2 * engine.mass_at_unit_density[i]);
    for (int e = engine.reciprocal_mass.start[i]; e < engine.reciprocal_mass.start[i + 1]; ++e)
      entries.emplace_back(i, engine.reciprocal_mass.node[e],
                           -engine.mass_at_unit_density[i] * engine.reciprocal_mass.value[e]);
  }
  Eigen::SparseMatrix<double> mass(nodes, nodes);
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

double largest_entry(const Eigen::SparseMatrix<double>& matrix) {
  double result = 0;
  for (int c = 0; c < matrix.outerSize(); ++c)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, c); entry; ++entry)
      result = std::max(result, std::abs(entry.value()));
  return result;
}

void compare_spaces(const ShapeSpec& shape, DiscretisationSettings settings, LargestFigures& figures) {
  SCOPED_TRACE(described(shape, settings));
  const FieldMesh mesh = make_field_mesh(shape);
  settings.mass = Mass::corrected;
  const reference::Space own = reference::make_space(mesh, settings);
  const Discretisation engine = discretise(mesh, settings);
  ASSERT_EQ(own.points.size(), engine.table.weight.size());
  double gradient_scale = 0, weight_scale = 0;
  for (const Vec2& b : engine.table.gradient) gradient_scale = std::max(gradient_scale, b.cwiseAbs().maxCoeff());
  for (const double w : engine.table.weight) weight_scale = std::max(weight_scale, w);
  const PointDifference points = difference(own, engine.table);
  const double values = std::max(difference(own.outline, engine.outline_rows), difference(own.nodes, engine.node_rows));
  double lumped = 0;
  for (std::size_t i = 0; i < engine.mass_at_unit_density.size(); ++i)
    lumped = std::max(lumped, std::abs(own.lumped[static_cast<Eigen::Index>(i)] - engine.mass_at_unit_density[i]));
  const Eigen::SparseMatrix<double> rest = own.consistent - engine_mass(engine);
  const double mass_scale = own.lumped.maxCoeff();
  const auto expect_agreement = [&](const char* what, double error) {
    EXPECT_LT(error, entry_tolerance) << what;
    figures.note(std::string(what) + ": " + name_of(settings), error);
  };
  expect_agreement("shape functions", values);
  expect_agreement("weights", points.weight / weight_scale);
  expect_agreement("gradients", points.gradient / gradient_scale);
  expect_agreement("lumped mass", lumped / mass_scale);
  expect_agreement("consistent mass", largest_entry(rest) / mass_scale);
}

TEST(ReferenceAgainstEngine, discretisations_agree) {
  LargestFigures figures;
  for (const ShapeSpec& shape : reference_shapes())
    for (const DiscretisationSettings& settings : reference_methods()) compare_spaces(shape, settings, figures);
}

}  // namespace
}  // namespace pliant
