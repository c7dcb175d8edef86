#include "reference/discretisation/moving_least_squares.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "reference/jet.hpp"

namespace pliant::reference {
namespace {

/// A node this close to its radius has no weight but rounding's: whether it counts must not hang on the last bit.
constexpr double reach = 1 - 1e-8;
/// Smaller shares of the constant that the linear functions leave over come from nodes on one line.
constexpr double least_remainder = 1e-8;

template <class Scalar>
using Column = std::vector<Scalar>;

template <class Scalar>
Scalar dot(const Column<Scalar>& a, const Column<Scalar>& b) {
  Scalar sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Takes from `column` its part along `direction`.
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

/// Shape functions at (x, y) of nodes with their radii: QR of the weighted basis, the constant its last column. What
/// the columns of the linear functions leave of it gives the value of the fit at (x, y).
template <class Scalar>
Column<Scalar> shape_functions(const Points& nodes, const std::vector<double>& radius, const Scalar& x,
                               const Scalar& y) {
  using std::sqrt;
  const std::size_t n = nodes.size();
  Column<Scalar> root(n), linear_x(n), linear_y(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Scalar dx = nodes[i].x() - x, dy = nodes[i].y() - y;
    root[i] = sqrt(spline(Scalar((dx * dx + dy * dy) / (radius[i] * radius[i]))));
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

/// Distance of each node to its support-th nearest other one.
std::vector<double> support_radii(const Points& nodes, int support) {
  std::vector<double> radius, distance(nodes.size());
  for (const Vec2& from : nodes) {
    for (std::size_t i = 0; i < nodes.size(); ++i) distance[i] = (nodes[i] - from).norm();
    std::nth_element(distance.begin(), distance.begin() + support, distance.end());  // the node itself comes first
    radius.push_back(distance[support]);
  }
  return radius;
}

}  // namespace

MovingLeastSquares::MovingLeastSquares(Points nodes, int support) : nodes_(std::move(nodes)) {
  if (support < 3 || std::size_t(support) >= nodes_.size())
    throw InputError(fmt::format("support = {} neighbours: at least 3, and fewer than the shape's {} nodes", support,
                                 nodes_.size()));
  radius_ = support_radii(nodes_, support);
}

std::vector<int> MovingLeastSquares::neighbours(const Vec2& x) const {
  std::vector<int> found;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if ((nodes_[i] - x).norm() < reach * radius_[i]) found.push_back(int(i));
  return found;
}

namespace {

/// The shape functions of some nodes at a place; throws where they do not exist.
template <class Scalar>
Column<Scalar> functions_at(const Points& nodes, const std::vector<double>& radius, const std::vector<int>& chosen,
                            const Scalar& x, const Scalar& y) {
  Points place;
  std::vector<double> reaches;
  for (int i : chosen) place.push_back(nodes[i]), reaches.push_back(radius[i]);
  Column<Scalar> functions = shape_functions(place, reaches, x, y);
  if (chosen.size() < 3 || functions.empty())
    throw InputError(
        fmt::format("the {} nodes near ({:.3g}, {:.3g}) mean node distances do not determine a linear "
                    "function there: use fewer outline_nodes, more nodes or a larger `support`",
                    chosen.size(), value_of(x), value_of(y)));
  return functions;
}

}  // namespace

Row MovingLeastSquares::values(const Vec2& x) const {
  Row row{neighbours(x), {}};
  row.value = functions_at(nodes_, radius_, row.node, x.x(), x.y());
  return row;
}

Point MovingLeastSquares::gradients(const Vec2& x) const {
  Point point;
  point.node = neighbours(x);
  for (const Jet<2>& phi : functions_at(nodes_, radius_, point.node, Jet<2>(x.x(), 0), Jet<2>(x.y(), 1)))
    point.gradient.push_back(phi.gradient);
  return point;
}

}  // namespace pliant::reference
