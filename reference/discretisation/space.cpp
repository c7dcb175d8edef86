#include "reference/discretisation/space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "reference/discretisation/consistency.hpp"
#include "reference/discretisation/moving_least_squares.hpp"
#include "reference/discretisation/quadrature.hpp"

namespace pliant::reference {
namespace {

double triangle_area(const FieldMesh& mesh, const Triangle& t) {
  return pliant::cross(mesh.nodes[t[1]] - mesh.nodes[t[0]], mesh.nodes[t[2]] - mesh.nodes[t[0]]) / 2;
}

Vec2 place(const FieldMesh& mesh, const Triangle& t, const Eigen::Vector3d& barycentric) {
  return barycentric[0] * mesh.nodes[t[0]] + barycentric[1] * mesh.nodes[t[1]] + barycentric[2] * mesh.nodes[t[2]];
}

double mean_node_distance(const FieldMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += triangle_area(mesh, t);
  return std::sqrt(sum / double(mesh.nodes.size()));
}

/// Points of a rule in every triangle, with gradients by moving least squares.
std::vector<Point> gauss_points(const FieldMesh& mesh, const MovingLeastSquares& mls, int count) {
  std::vector<Point> points;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const QuadraturePoint& at : triangle_rule(count)) {
      points.push_back(mls.gradients(place(mesh, mesh.triangles[t], at.place)));
      points.back().weight = at.share * triangle_area(mesh, mesh.triangles[t]);
      points.back().triangles = {int(t)};
    }
  return points;
}

/// Adds the contribution of a triangle to one point: [node] to the sum of weight x gradient.
void add_linear_triangle(std::map<int, Vec2>& sum, const FieldMesh& mesh, const Triangle& t, double weight) {
  for (int corner = 0; corner < 3; ++corner) {
    const Vec2 opposite = mesh.nodes[t[(corner + 2) % 3]] - mesh.nodes[t[(corner + 1) % 3]];
    const Vec2 gradient = Vec2(-opposite.y(), opposite.x()) / (2 * triangle_area(mesh, t));
    sum.try_emplace(t[corner], Vec2::Zero()).first->second += weight * gradient;
  }
}

/// Point that represents a share of the area of some triangles, with the mean of their gradients, weighted by area.
Point mean_point(const FieldMesh& mesh, const std::vector<int>& triangles, double share) {
  Point point;
  std::map<int, Vec2> sum;
  for (int t : triangles) {
    const double weight = share * triangle_area(mesh, mesh.triangles[t]);
    add_linear_triangle(sum, mesh, mesh.triangles[t], weight);
    point.weight += weight;
  }
  point.triangles = triangles;
  for (const auto& [node, gradient] : sum) {
    point.node.push_back(node);
    point.gradient.push_back(gradient / point.weight);
  }
  return point;
}

std::vector<Point> triangle_points(const FieldMesh& mesh) {
  std::vector<Point> points;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) points.push_back(mean_point(mesh, {int(t)}, 1));
  return points;
}

std::vector<Point> edge_points(const FieldMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<int>> triangles_of;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int corner = 0; corner < 3; ++corner) {
      const int a = mesh.triangles[t][corner], b = mesh.triangles[t][(corner + 1) % 3];
      triangles_of[std::minmax(a, b)].push_back(int(t));
    }
  std::vector<Point> points;
  for (const auto& [edge, triangles] : triangles_of) points.push_back(mean_point(mesh, triangles, 1.0 / 3));
  return points;
}

Row linear_row(const Triangle& t, const Eigen::Vector3d& barycentric) {
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return t[a] < t[b]; });
  Row row;
  for (int corner : order) row.node.push_back(t[corner]), row.value.push_back(barycentric[corner]);
  return row;
}

/// Adds consistent and lumped mass by 6 points per triangle, from the shape functions of a triangle at a point in it.
void add_masses(Space& space, const std::function<Row(const Triangle&, const Eigen::Vector3d&)>& functions) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> weights;
  for (const Triangle& t : space.mesh.triangles)
    for (const QuadraturePoint& at : triangle_rule(6)) {
      const Row row = functions(t, at.place);
      for (std::size_t i = 0; i < row.node.size(); ++i)
        entries.emplace_back(int(weights.size()), row.node[i], row.value[i]);
      weights.push_back(at.share * triangle_area(space.mesh, t));
    }
  Eigen::SparseMatrix<double> values(Eigen::Index(weights.size()), Eigen::Index(space.mesh.nodes.size()));
  values.setFromTriplets(entries.begin(), entries.end());
  const Eigen::Map<const Eigen::VectorXd> weight(weights.data(), Eigen::Index(weights.size()));
  const Eigen::SparseMatrix<double> weighted = weight.asDiagonal() * values;
  space.consistent = Eigen::SparseMatrix<double>(values.transpose()) * weighted;
  space.lumped = values.transpose() * weight;
  Eigen::Index worst = 0;
  if (!(space.lumped.minCoeff(&worst) > 0))
    throw InputError(
        fmt::format("node {} would have the lumped mass {:.2e}, not positive: use a smaller `support` or "
                    "the method \"es-t3\"",
                    worst, space.lumped[worst]));
}

/// Discretisation by mesh functions, whose values at nodes are nodal values.
void fill_with_triangles(Space& space, DiscretisationMethod method) {
  space.points = method == DiscretisationMethod::t3 ? triangle_points(space.mesh) : edge_points(space.mesh);
  for (int i = 0; i < int(space.mesh.nodes.size()); ++i) space.nodes.push_back({{i}, {1.0}});
  add_masses(space, linear_row);
}

void fill_with_moving_least_squares(Space& space, const DiscretisationSettings& settings) {
  const MovingLeastSquares mls(space.mesh.nodes, space.mesh.outline_count, settings.support);
  for (const Vec2& node : space.mesh.nodes) space.nodes.push_back(mls.values(node));
  const std::vector<Row> outline(space.nodes.begin(), space.nodes.begin() + space.mesh.outline_count);
  space.points =
      gauss_points(space.mesh, mls, settings.method == DiscretisationMethod::mls ? 1 : settings.gauss_points);
  if (settings.method == DiscretisationMethod::mls) make_consistent(space.points, space.mesh.nodes, outline);
  add_masses(space, [&](const Triangle& t, const Eigen::Vector3d& at) { return mls.values(place(space.mesh, t, at)); });
}

}  // namespace

Space make_space(const FieldMesh& mesh, const DiscretisationSettings& settings) {
  if (settings.method == DiscretisationMethod::rpim)
    throw InputError(
        "the reference solver has no method \"rpim\": it has \"mls\", \"mls-gauss\", \"t3\" and \"es-t3\"");
  const double unit = mean_node_distance(mesh);  // scale of all lengths, until the last lines
  Space space;
  space.mesh = mesh;
  for (Vec2& node : space.mesh.nodes) node /= unit;
  if (settings.method == DiscretisationMethod::t3 || settings.method == DiscretisationMethod::es_t3)
    fill_with_triangles(space, settings.method);
  else
    fill_with_moving_least_squares(space, settings);
  space.outline.assign(space.nodes.begin(), space.nodes.begin() + mesh.outline_count);
  for (Point& point : space.points) {
    point.weight *= unit * unit;
    for (Vec2& gradient : point.gradient) gradient /= unit;
  }
  space.lumped *= unit * unit;
  space.consistent *= unit * unit;
  space.mesh = mesh;
  return space;
}

}  // namespace pliant::reference
