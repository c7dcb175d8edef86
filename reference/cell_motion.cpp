#include "reference/cell_motion.hpp"

#include <algorithm>

#include <Eigen/LU>

namespace pliant::reference {

CellMotion::CellMotion(const Scene& scene, double from, double until) {
  if (!scene.cell) return;
  const Eigen::Matrix2d before = Periods(scene, from).vectors();
  change_ = Periods(scene, until).vectors() - before;
  growth_ = change_ * before.inverse();
}

Vector CellMotion::carried(const Bodies& bodies, const Vector& q) const {
  Vector result = q;
  if (growth_.isZero(0)) return result;
  for (const Body& body : bodies.all()) {
    const Vec2 moved = growth_ * centre_of(bodies, body, q);
    for (int i = 0; i < (body.compliant() ? body.dofs : 2); i += 2) result.segment<2>(body.first_dof + i) += moved;
  }
  return result;
}

double CellMotion::parting(const Bodies& bodies) const {
  double widest = 0;
  for (const Body& body : bodies.all())
    for (const Vec2& p : body.outline) widest = std::max(widest, p.norm());
  return growth_.norm() * 2 * widest;
}

Eigen::Matrix2d gradient_rate(const Scene& scene, double time) {
  Eigen::Matrix2d rate = Eigen::Matrix2d::Zero();
  if (!scene.cell) return rate;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      if (const History& one = scene.cell->gradient[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
          one.time.size() > 1)
        rate(i, j) = one.slope(time);
  return rate;
}

Eigen::Matrix2d velocity_gradient(const Scene& scene, double time, const Eigen::Matrix2d& rate) {
  if (!scene.cell) return Eigen::Matrix2d::Zero();
  return rate * scene.cell->gradient_at(time).inverse();
}

Vector velocities_of_flow(const Bodies& bodies, const Vector& q, const Eigen::Matrix2d& gradient) {
  Vector v = Vector::Zero(q.size());
  for (const Body& body : bodies.all()) {
    const int d = body.first_dof;
    for (int i = 0; i < (body.compliant() ? body.dofs : 2); i += 2)
      v.segment<2>(d + i) = gradient * q.segment<2>(d + i);
    if (!body.compliant()) v[d + 2] = (gradient(1, 0) - gradient(0, 1)) / 2;
  }
  return v;
}

Vec2 centre_of(const Bodies& bodies, const Body& body, const Vector& q) {
  if (!body.compliant()) return q.segment<2>(body.first_dof);
  const Vector& mass = bodies.space_of(body).lumped;
  Vec2 sum(0, 0);
  for (int i = 0; i < mass.size(); ++i) sum += mass[i] * q.segment<2>(body.first_dof + 2 * i);
  return sum / mass.sum();
}

std::vector<double> history_times_of_cell(const Scene& scene) {
  std::vector<double> times;
  if (!scene.cell) return times;
  for (const auto& row : scene.cell->gradient)
    for (const History& one : row)
      if (one.time.size() > 1) times.insert(times.end(), one.time.begin(), one.time.end());
  return times;
}

std::vector<int> held_in_cell(const Bodies& bodies) {
  if (!bodies.scene().cell || bodies.all().empty()) return {};
  const int first = bodies.all().front().first_dof;
  return {first, first + 1};
}

}  // namespace pliant::reference
