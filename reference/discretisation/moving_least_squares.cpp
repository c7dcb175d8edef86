#include "reference/discretisation/moving_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "reference/jet.hpp"

namespace pliant::reference {
namespace {

/// A node this close to its radius has only a weight of rounding: whether it counts must not depend on the last bit.
constexpr double reach = 1 - 1e-8;
/// Least share of the constant that the linear functions leave: smaller shares come from collinear nodes.
constexpr double least_remainder = 1e-8;

template <class Scalar>
using Column = std::vector<Scalar>;

template <class Scalar>
Scalar dot(const Column<Scalar>& a, const Column<Scalar>& b) {
  Scalar sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Removes the part of `column` along `direction`.
template <class Scalar>
void remove_part(Column<Scalar>& column, const Column<Scalar>& direction) {
  const Scalar share = dot(column, direction) / dot(direction, direction);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] -= share * direction[i];
}

double value_of(double x) { return x; }
template <int N>
double value_of(const Jet<N>& x) {
  return x.value;
}

/// Cubic spline of the distance over the radius, given squared: smooth at 0, where the root is not.
template <class Scalar>
Scalar spline(const Scalar& square) {
  using std::sqrt;
  if (value_of(square) == 0) return 2.0 / 3 - 4.0 * square;
  const Scalar q = sqrt(square);
  if (value_of(q) <= 0.5) return 2.0 / 3 - 4.0 * square + 4.0 * square * q;
  const Scalar rest = 1.0 - q;
  return 4.0 / 3 * rest * rest * rest;  // 4/3 - 4 q + 4 q^2 - 4/3 q^3 without its cancellation at q = 1
}

/// Data of one node for its shape function at a position.
struct Support {
  Vec2 node;
  double radius;
  Leg leg;  ///< of the path to the node
};

/// Square of the distance through the body over the radius.
template <class Scalar>
Scalar square_distance(const Support& support, const Scalar& x, const Scalar& y) {
  using std::sqrt;
  const Scalar dx = support.leg.to.x() - x, dy = support.leg.to.y() - y;
  Scalar square = dx * dx + dy * dy;
  if (support.leg.rest > 0) {
    const Scalar whole = sqrt(square) + support.leg.rest;
    square = whole * whole;
  }
  return square / (support.radius * support.radius);
}

/// Shape functions at (x, y) of nodes with their radii: QR of the weighted basis with the constant as its last column.
/// The remainder of that column after the linear functions gives the value of the fit at (x, y).
template <class Scalar>
Column<Scalar> shape_functions(const std::vector<Support>& supports, const Scalar& x, const Scalar& y) {
  using std::sqrt;
  const std::size_t n = supports.size();
  Column<Scalar> root(n), linear_x(n), linear_y(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Scalar dx = supports[i].node.x() - x, dy = supports[i].node.y() - y;
    root[i] = sqrt(spline(square_distance(supports[i], x, y)));
    linear_x[i] = root[i] * dx;
    linear_y[i] = root[i] * dy;
  }
  Column<Scalar> rest = root;
  for (int pass = 0; pass < 2; ++pass) {  // twice: orthogonal to rounding
    remove_part(linear_y, linear_x);
    remove_part(rest, linear_x);
    remove_part(rest, linear_y);
  }
  const Scalar norm = dot(rest, root);
  if (!(value_of(norm) > least_remainder * value_of(dot(root, root)))) return {};
  for (std::size_t i = 0; i < n; ++i) rest[i] = rest[i] * root[i] / norm;
  return rest;
}

/// Distance of each node to its support-th nearest other one. A path is no shorter than a straight line, so nodes
/// further away than the present radius are not tested.
std::vector<double> support_radii(const Points& nodes, const BodyDistances& distances, int support) {
  std::vector<double> radius;
  std::vector<std::size_t> order(nodes.size());
  std::iota(order.begin(), order.end(), 0);
  for (const Vec2& from : nodes) {
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return (nodes[i] - from).norm() < (nodes[j] - from).norm(); });
    std::vector<double> nearest(support + 1, std::numeric_limits<double>::infinity());  // the node itself comes first
    for (const std::size_t i : order) {
      if ((nodes[i] - from).norm() >= nearest.back()) break;
      const double distance = distances.first_leg(from, nodes[i], nearest.back()).length_from(from);
      if (distance >= nearest.back()) continue;
      nearest.back() = distance;
      std::sort(nearest.begin(), nearest.end());
    }
    radius.push_back(nearest.back());
  }
  return radius;
}

}  // namespace

MovingLeastSquares::MovingLeastSquares(Points nodes, int outline_count, int support)
    : nodes_(std::move(nodes)), distances_(Points(nodes_.begin(), nodes_.begin() + outline_count)) {
  if (support < 3 || std::size_t(support) >= nodes_.size())
    throw InputError(fmt::format("support = {} neighbours: at least 3, and fewer than the shape's {} nodes", support,
                                 nodes_.size()));
  radius_ = support_radii(nodes_, distances_, support);
}

std::vector<int> MovingLeastSquares::neighbours(const Vec2& x) const {
  std::vector<int> found;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const double limit = reach * radius_[i];
    if ((nodes_[i] - x).norm() < limit && distances_.first_leg(x, nodes_[i], limit).length_from(x) < limit)
      found.push_back(int(i));
  }
  return found;
}

/// Shape functions of some nodes at a position; throws where they do not exist.
template <class Scalar>
std::vector<Scalar> MovingLeastSquares::functions_at(const std::vector<int>& chosen, const Scalar& x,
                                                     const Scalar& y) const {
  std::vector<Support> supports;
  const Vec2 place(value_of(x), value_of(y));
  for (int i : chosen) supports.push_back({nodes_[i], radius_[i], distances_.first_leg(place, nodes_[i], radius_[i])});
  Column<Scalar> functions = shape_functions(supports, x, y);
  if (chosen.size() < 3 || functions.empty())
    throw InputError(
        fmt::format("the {} nodes near ({:.3g}, {:.3g}) mean node distances do not determine a linear "
                    "function there: use fewer outline_nodes, more nodes or a larger `support`",
                    chosen.size(), place.x(), place.y()));
  return functions;
}

Row MovingLeastSquares::values(const Vec2& x) const {
  Row row{neighbours(x), {}};
  row.value = functions_at(row.node, x.x(), x.y());
  return row;
}

Point MovingLeastSquares::gradients(const Vec2& x) const {
  Point point;
  point.node = neighbours(x);
  for (const Jet<2>& phi : functions_at(point.node, Jet<2>(x.x(), 0), Jet<2>(x.y(), 1)))
    point.gradient.push_back(phi.gradient);
  return point;
}

}  // namespace pliant::reference
