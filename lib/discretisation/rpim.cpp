#include "discretisation/rpim.hpp"

#include <cmath>

#include <Eigen/Dense>

namespace pliant {
namespace {

constexpr double shape_parameter = 1.0, shape_exponent = 1.03;

double radial(double squared_distance) {
  return std::pow(squared_distance + shape_parameter * shape_parameter, shape_exponent);
}

Vec2 radial_gradient(const Vec2& r) {
  return 2 * shape_exponent * std::pow(r.squaredNorm() + shape_parameter * shape_parameter, shape_exponent - 1) * r;
}

std::vector<int> supporting_nodes(const MlsNodes& nodes, const Vec2& x) {
  std::vector<int> found;
  const WaysToNodes ways(nodes, x, nodes.reach);
  for (const int i : nodes.near(x))
    if ((nodes.position[i] - x).norm() < nodes.radius[i] && ways(i).norm() < nodes.radius[i]) found.push_back(i);
  return found;
}

}  // namespace

// phi = (r(x), p(x)) G^-1, G the moment matrix of the nodes; the basis is centred at x, where p = (1, 0, 0).
Basis radial_point_interpolation(const MlsNodes& nodes) {
  return [nodes](const Vec2& x, int) {
    ShapeFunctions shape;
    shape.node = supporting_nodes(nodes, x);
    const auto n = static_cast<Eigen::Index>(shape.node.size());
    Eigen::MatrixXd moment = Eigen::MatrixXd::Zero(n + 3, n + 3);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n + 3, 3);  // value, derivatives by x and y
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vec2 r = nodes.position[shape.node[i]] - x;
      for (Eigen::Index j = 0; j < n; ++j)
        moment(i, j) = radial((nodes.position[shape.node[i]] - nodes.position[shape.node[j]]).squaredNorm());
      moment.row(i).tail(3) << 1, r.x(), r.y();
      moment.col(i).tail(3) << 1, r.x(), r.y();
      right.row(i) << radial(r.squaredNorm()), radial_gradient(-r).transpose();
    }
    right.bottomRows(3) = Eigen::Matrix3d::Identity();
    const Eigen::FullPivLU<Eigen::MatrixXd> factors(moment);
    const Eigen::MatrixXd solution = factors.solve(right);
    shape.condition = 1 / factors.rcond();
    for (Eigen::Index i = 0; i < n; ++i) {
      shape.value.push_back(solution(i, 0));
      shape.gradient.emplace_back(solution(i, 1), solution(i, 2));
    }
    return shape;
  };
}

}  // namespace pliant
