#include "reference/materials/internal.hpp"

#include <algorithm>
#include <cmath>

#include "reference/jet.hpp"
#include "reference/materials/plastic.hpp"

namespace pliant::reference {
namespace {

/// F at a point, from the list of all points' entries.
Deformation<double> entries_at(const Eigen::VectorXd& F, Eigen::Index point) {
  return {F[4 * point], F[4 * point + 1], F[4 * point + 2], F[4 * point + 3]};
}

/// F with its entries as variables 0 to 3; with five variables zz is variable 4.
template <int N>
Deformation<Jet<N>> as_variables(const Deformation<double>& F) {
  Deformation<Jet<N>> result{Jet<N>(F.xx, 0), Jet<N>(F.xy, 1), Jet<N>(F.yx, 2), Jet<N>(F.yy, 3)};
  if constexpr (N == 5) result.zz = Jet<N>(F.zz, 4);
  return result;
}

/// Zeros at the possible entries of a stiffness matrix: [n x n] from gradients [4 points x n].
Eigen::SparseMatrix<double> pattern_of(const Eigen::SparseMatrix<double>& gradient) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < gradient.rows(); ++row)
    for (int column = row - row % 4; column < row - row % 4 + 4; ++column) entries.emplace_back(row, column, 1);
  Eigen::SparseMatrix<double> blocks(gradient.rows(), gradient.rows());
  blocks.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseMatrix<double> columns = blocks * gradient;
  Eigen::SparseMatrix<double> result = Eigen::SparseMatrix<double>(gradient.transpose()) * columns;
  result.coeffs().setZero();
  return result;
}

/// Index of an entry in a matrix's values.
int place_of(const Eigen::SparseMatrix<double>& matrix, int row, int column) {
  const int *first = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column],
            *last = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - matrix.innerIndexPtr());
}

}  // namespace

InternalForces::InternalForces(const Space& space, const Material& material, double size, double angle)
    : material_(material), cos_(std::cos(angle)), sin_(std::sin(angle)), weight_(space.points.size()) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t g = 0; g < space.points.size(); ++g) {
    const Point& point = space.points[g];
    weight_[Eigen::Index(g)] = point.weight * size * size;
    for (std::size_t i = 0; i < point.node.size(); ++i)
      for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 2; ++column)
          entries.emplace_back(4 * int(g) + 2 * row + column, 2 * point.node[i] + row,
                               point.gradient[i][column] / size);
  }
  gradient_.resize(4 * weight_.size(), 2 * Eigen::Index(space.mesh.nodes.size()));
  gradient_.setFromTriplets(entries.begin(), entries.end());
  pattern_ = pattern_of(gradient_);
  for (std::size_t g = 0; g < space.points.size(); ++g) at_point_.push_back(gradient_at(int(g), space.points[g].node));
  if (has_branch() || is_plastic()) history_.resize(space.points.size());
}

InternalForces::PointGradient InternalForces::gradient_at(int point, const std::vector<int>& nodes) const {
  std::vector<int> dofs;
  for (const int node : nodes) dofs.insert(dofs.end(), {2 * node, 2 * node + 1});
  PointGradient result{Gradient(4, dofs.size()), {}};
  for (std::size_t i = 0; i < dofs.size(); ++i)
    for (int row = 0; row < 4; ++row) result.gradient(row, Eigen::Index(i)) = gradient_.coeff(4 * point + row, dofs[i]);
  for (const int column : dofs)
    for (const int row : dofs) result.place.push_back(place_of(pattern_, row, column));
  return result;
}

template <class Scalar>
Deformation<Scalar> InternalForces::measured(const Deformation<Scalar>& F) const {
  if (material_.law != MaterialLaw::linear_elastic) return F;
  return {F.xx * cos_ - F.xy * sin_, F.xx * sin_ + F.xy * cos_, F.yx * cos_ - F.yy * sin_, F.yx * sin_ + F.yy * cos_,
          F.zz};  // F R^T
}

Eigen::SparseMatrix<double> InternalForces::at_nodes(const std::vector<Eigen::Matrix4d>& of_points) const {
  Eigen::SparseMatrix<double> matrix = pattern_;
  double* values = matrix.valuePtr();
  for (std::size_t g = 0; g < of_points.size(); ++g) {
    const PointGradient& point = at_point_[g];
    const Eigen::MatrixXd block = point.gradient.transpose() * of_points[g] * point.gradient;
    for (std::size_t k = 0; k < point.place.size(); ++k) values[point.place[k]] += block.data()[k];
  }
  return matrix;
}

/// dG/dt by the trapezoidal rule: G = (1 - 2 s) G_old + s (goal_old + goal), s = z / (2 + z), z the time over the
/// relaxation time.
void InternalForces::add_branch(Eigen::Index point, const Deformation<double>& F, double elapsed,
                                Eigen::Vector4d& stress, Eigen::Matrix4d& stiffness, InternalState& state) const {
  const PointHistory& old = history_[std::size_t(point)];
  const Symmetric<Jet<4>> goal = inverse_metric(as_variables<4>(F));
  const bool relaxed = std::isinf(elapsed);
  const double z = elapsed / material_.relaxation_time, share = relaxed ? 1 : z / (2 + z);
  const auto follow = [&](double viscous, double goal_before, const Jet<4>& to) {
    return relaxed ? to : Jet<4>((1 - 2 * share) * viscous + share * goal_before) + share * to;
  };
  const Symmetric<Jet<4>> G{follow(old.metric.xx, old.goal.xx, goal.xx), follow(old.metric.xy, old.goal.xy, goal.xy),
                            follow(old.metric.yy, old.goal.yy, goal.yy)};
  const Jet<7> energy = branch_energy(material_, as_variables<7>(F),
                                      {Jet<7>(G.xx.value, 4), Jet<7>(G.xy.value, 5), Jet<7>(G.yy.value, 6)});
  Eigen::Matrix<double, 3, 4> by_F;
  by_F << G.xx.gradient.transpose(), G.xy.gradient.transpose(), G.yy.gradient.transpose();
  const Eigen::Vector3d rate =
      Eigen::Vector3d(goal.xx.value - G.xx.value, goal.xy.value - G.xy.value, goal.yy.value - G.yy.value) /
      material_.relaxation_time;
  stress += energy.gradient.head<4>();
  stiffness += energy.hessian.topLeftCorner<4, 4>() + energy.hessian.topRightCorner<4, 3>() * by_F;
  state.energy += weight_[point] * energy.value;
  state.power -= weight_[point] * energy.gradient.tail<3>().dot(rate);
  state.history.push_back({{G.xx.value, G.xy.value, G.yy.value}, {goal.xx.value, goal.xy.value, goal.yy.value}});
}

InternalState InternalForces::evaluate(const Eigen::VectorXd& q, bool tangent, double elapsed) const {
  const Eigen::VectorXd F = gradient_ * q;
  InternalState state;
  Eigen::VectorXd stress(F.size());
  std::vector<Eigen::Matrix4d> stiffness;
  for (Eigen::Index g = 0; g < weight_.size(); ++g) {
    const double J = jacobian(entries_at(F, g));
    if (g == 0 || J < state.least_jacobian || std::isnan(J)) state.least_jacobian = J, state.least_point = int(g);
  }
  if (!(state.least_jacobian > 0)) return state;  // only `linear_elastic` has an energy there
  for (Eigen::Index g = 0; g < weight_.size(); ++g) {
    Eigen::Vector4d P;
    Eigen::Matrix4d by_F;
    if (is_plastic()) {
      const PlasticIncrement found = plastic_increment(material_, entries_at(F, g), history_[std::size_t(g)], elapsed);
      P = found.stress, by_F = found.stiffness;
      state.energy += weight_[g] * found.energy, state.loss += weight_[g] * found.loss;
      state.history.push_back(found.now);
    } else {
      const Jet<4> energy = strain_energy(material_, measured(as_variables<4>(entries_at(F, g))));
      state.energy += weight_[g] * energy.value;
      P = energy.gradient, by_F = energy.hessian;
    }
    if (has_branch()) add_branch(g, entries_at(F, g), elapsed, P, by_F, state);
    stress.segment<4>(4 * g) = weight_[g] * P;
    if (tangent) stiffness.push_back(weight_[g] * by_F);
  }
  state.residual = gradient_.transpose() * stress;
  if (tangent) state.tangent = at_nodes(stiffness);
  return state;
}

ViscousState InternalForces::damping(const Eigen::VectorXd& q, const Eigen::VectorXd& v, bool tangent) const {
  const Eigen::VectorXd F = gradient_ * q, rate = gradient_ * v;
  Eigen::VectorXd stress(F.size());
  std::vector<Eigen::Matrix4d> by_positions, by_velocities;
  for (Eigen::Index g = 0; g < weight_.size(); ++g) {
    const Deformation<double> at = entries_at(F, g), change = entries_at(rate, g);
    const Jet<8> potential =
        viscous_potential(material_.viscosity, as_variables<8>(at),
                          {Jet<8>(change.xx, 4), Jet<8>(change.xy, 5), Jet<8>(change.yx, 6), Jet<8>(change.yy, 7)});
    stress.segment<4>(4 * g) = weight_[g] * potential.gradient.tail<4>();
    if (!tangent) continue;
    by_positions.emplace_back(weight_[g] * potential.hessian.bottomLeftCorner<4, 4>());
    by_velocities.emplace_back(weight_[g] * potential.hessian.bottomRightCorner<4, 4>());
  }
  ViscousState state{.residual = gradient_.transpose() * stress, .by_positions = {}, .by_velocities = {}};
  if (tangent) state.by_positions = at_nodes(by_positions), state.by_velocities = at_nodes(by_velocities);
  return state;
}

std::vector<PointStress> InternalForces::stresses(const Eigen::VectorXd& q) const {
  const Eigen::VectorXd all = gradient_ * q;
  std::vector<PointStress> result;
  for (Eigen::Index g = 0; g < weight_.size(); ++g) {
    // Derivative by the F of the law, which for small strains is also that of the stress.
    const Deformation<double> F = measured(entries_at(all, g));
    Jet<5> energy =
        is_plastic()
            ? elastic_energy(moduli(material_), LogarithmicStrain<Jet<5>>(as_variables<5>(F), history_[std::size_t(g)]))
            : strain_energy(material_, as_variables<5>(F));
    if (has_branch()) {
      const Symmetric<double>& G = history_[std::size_t(g)].metric;
      energy += branch_energy(material_, as_variables<5>(F), Symmetric<Jet<5>>{G.xx, G.xy, G.yy});
    }
    const auto& P = energy.gradient;
    const double J = jacobian(F);
    if (material_.law == MaterialLaw::linear_elastic)
      result.push_back({P[0], P[3], P[1], P[4], J, energy.value});
    else  // P F^T / J
      result.push_back({(P[0] * F.xx + P[1] * F.xy) / J, (P[2] * F.yx + P[3] * F.yy) / J,
                        (P[0] * F.yx + P[1] * F.yy) / J, P[4] / J, J, energy.value});
    if (is_plastic()) result.back().plastic_strain = history_[std::size_t(g)].plastic_strain;
  }
  return result;
}

}  // namespace pliant::reference
