#include "discretisation/mls.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <numeric>

#include "core/errors.hpp"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Share of the radius beyond which a node is no neighbour: value and gradient of its weight are below rounding there,
// and a node at exactly the radius must not depend on the last bit.
constexpr double support_edge = 1 - 1e-8;
// Reciprocal condition number of the moment matrix below which the neighbours count as collinear.
constexpr double least_condition = 1e-12;

struct Weight {
  double value, slope;  // slope: derivative by q
};

// Cubic spline, q = distance / radius in [0, 1].
Weight cubic_spline(double q) {
  if (q <= 0.5) return {2.0 / 3 + 4 * q * q * (q - 1), 4 * q * (3 * q - 2)};
  const double s = 1 - q;
  return {4.0 / 3 * s * s * s, -4 * s * s};
}

struct Neighbour {
  int node;
  Vector3d basis;  // (1, X_i - x)
  double weight;
  Vec2 weight_gradient;  // by x
};

std::vector<Neighbour> find_neighbours(const MlsNodes& nodes, const Vec2& x) {
  std::vector<Neighbour> found;
  const WaysToNodes ways(nodes, x, nodes.reach);
  for (const int i : nodes.near(x)) {
    const Vec2 r = nodes.position[i] - x;
    const double radius = nodes.radius[i], limit = support_edge * radius;
    if (r.squaredNorm() >= limit * limit) continue;
    const Vec2 way = ways(i);
    const double distance = way.norm();
    if (distance >= limit) continue;
    const Weight w = cubic_spline(distance / radius);
    const Vec2 gradient = distance > 0 ? Vec2(-w.slope / (radius * distance) * way) : Vec2(0, 0);
    found.push_back({i, Vector3d(1, r.x(), r.y()), w.value, gradient});
  }
  return found;
}

struct InverseMoment {
  Matrix3d matrix;
  double condition;
};

InverseMoment inverse_moment(const std::vector<Neighbour>& neighbours, const Vec2& x) {
  Matrix3d moment = Matrix3d::Zero();
  for (const Neighbour& n : neighbours) moment += n.weight * n.basis * n.basis.transpose();
  const Eigen::PartialPivLU<Matrix3d> lu(moment);
  if (neighbours.size() < 3 || !(lu.rcond() > least_condition))
    throw TooFewNeighbours(
        fmt::format("discretisation: the point ({:.4g}, {:.4g}) (in mean node distances from the centroid) has "
                    "{} neighbour nodes, not three off one line",
                    x.x(), x.y(), neighbours.size()));
  return {lu.inverse(), 1 / lu.rcond()};
}

}  // namespace

MlsNodes make_mls_nodes(const Points& nodes, int support) {
  if (static_cast<int>(nodes.size()) <= support)
    throw InputError(fmt::format("discretisation: support = {} needs more than {} nodes; the shape has {}", support,
                                 support, nodes.size()));
  MlsNodes result{nodes, {}, 0, std::make_shared<NodeGrid>(make_node_grid(nodes))};
  for (const Vec2& x : nodes)  // the node itself is number 0
    result.radius.push_back(std::sqrt(result.grid->square_distance_to_nearest(x, support)));
  result.reach = *std::max_element(result.radius.begin(), result.radius.end());
  return result;
}

namespace {

// Distance of a node, through the body, to its support-th nearest other one.
double inner_radius(const MlsNodes& nodes, int i, int support) {
  const Vec2& x = nodes.position[i];
  for (double reach = nodes.radius[i];; reach *= 1.5) {
    const WaysToNodes ways(nodes, x, reach);
    std::vector<double> squared;
    for (const int j : nodes.grid->near(x, reach))
      if ((nodes.position[j] - x).squaredNorm() <= reach * reach) squared.push_back(ways(j).squaredNorm());
    if (static_cast<int>(squared.size()) <= support) continue;
    std::nth_element(squared.begin(), squared.begin() + support, squared.end());
    if (squared[support] <= reach * reach) return std::sqrt(squared[support]);
  }
}

}  // namespace

MlsNodes make_mls_nodes(const FieldMesh& mesh, int support) {
  MlsNodes result = make_mls_nodes(mesh.nodes, support);
  const auto paths =
      std::make_shared<const InnerPaths>(Points(mesh.nodes.begin(), mesh.nodes.begin() + mesh.outline_count));
  if (paths->convex()) return result;
  result.paths = paths;
  for (const Vec2& x : mesh.nodes) result.triangle.push_back(paths->triangle_at(x));
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i)
    if (paths->room(mesh.nodes[i], result.radius[i]) < result.radius[i])
      result.radius[i] = inner_radius(result, i, support);
  result.reach = *std::max_element(result.radius.begin(), result.radius.end());
  return result;
}

std::vector<int> MlsNodes::near(const Vec2& x) const {
  if (grid) return grid->near(x, reach);
  std::vector<int> all(position.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// With c(x) the first row of M^-1 in the basis centred at the fixed point, phi_i = c . p_i w_i. Moving x moves the
// point of the basis (first term of dc) and the weights in M (second term).
ShapeFunctions evaluate_mls(const MlsNodes& nodes, const Vec2& x) {
  const std::vector<Neighbour> neighbours = find_neighbours(nodes, x);
  const auto [inverse, condition] = inverse_moment(neighbours, x);
  const Vector3d c = inverse.col(0);
  Eigen::Matrix<double, 3, 2> moment_gradient_c = Eigen::Matrix<double, 3, 2>::Zero();  // (dM/dx_a) c
  for (const Neighbour& n : neighbours) moment_gradient_c += n.basis.dot(c) * n.basis * n.weight_gradient.transpose();
  const Eigen::Matrix<double, 3, 2> c_gradient = inverse.rightCols<2>() - inverse * moment_gradient_c;
  ShapeFunctions result;
  result.condition = condition;
  for (const Neighbour& n : neighbours) {
    result.node.push_back(n.node);
    result.value.push_back(c.dot(n.basis) * n.weight);
    result.gradient.push_back(n.weight * (c_gradient.transpose() * n.basis) + c.dot(n.basis) * n.weight_gradient);
  }
  return result;
}

Basis moving_least_squares(const MlsNodes& nodes) {
  return [nodes](const Vec2& x, int) { return evaluate_mls(nodes, x); };
}

}  // namespace pliant
