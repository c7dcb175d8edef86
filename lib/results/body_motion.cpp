#include "results/body_motion.hpp"

#include <Eigen/Geometry>

#include "bodies/nodal.hpp"

namespace pliant {
namespace {

Vec2 turned_left(const Vec2& v) { return {-v.y(), v.x()}; }

}  // namespace

const double* rigid_values(const Body& body, const Dofs& dofs) {
  return &dofs.rigid[3 * static_cast<std::size_t>(body.rigid)];
}

Vec2 mean_rate(const Model& model, const Body& body, const Dofs& rates) {
  if (body.kind == BodyKind::compliant) return mean_value(model, body, rates);
  const double* values = rigid_values(body, rates);
  return {values[0], values[1]};
}

Vec2 centre_of(const Model& model, const Body& body, const Dofs& position) {
  const Vec2 mean = mean_rate(model, body, position);
  return body.kind == BodyKind::compliant ? Vec2(body.centre + mean) : mean;
}

Vec2 arm_at_start(const Body& body, const Vec2& reference) {
  return Eigen::Rotation2Dd(body.angle) * (body.scale * reference);
}

Points positions_at(const Snapshot& snapshot, const Body& body, const Points& reference) {
  const Dofs& position = snapshot.state().position;
  if (body.kind == BodyKind::compliant) {
    Points points = nodal_values(snapshot.model(), body, position);
    for (Vec2& p : points) p += body.centre;
    return points;
  }
  const double* q = rigid_values(body, position);
  const Eigen::Rotation2Dd turn(q[2]);
  Points points;
  for (const Vec2& x : reference) points.emplace_back(Vec2(q[0], q[1]) + turn * (body.scale * x));
  return points;
}

Points displacements_at(const Snapshot& snapshot, const Body& body, const Points& reference) {
  Points points = positions_at(snapshot, body, reference);
  for (std::size_t k = 0; k < points.size(); ++k) points[k] -= body.centre + arm_at_start(body, reference[k]);
  return points;
}

Points velocities_at(const Snapshot& snapshot, const Body& body, const Points& reference) {
  const State& state = snapshot.state();
  if (body.kind == BodyKind::compliant) return nodal_values(snapshot.model(), body, snapshot.velocities());
  const double *q = rigid_values(body, state.position), *v = rigid_values(body, state.reduced_momentum);
  Points points = positions_at(snapshot, body, reference);
  for (Vec2& p : points) p = Vec2(v[0], v[1]) + v[2] * turned_left(p - Vec2(q[0], q[1]));
  return points;
}

Points accelerations_at(const Snapshot& snapshot, const Body& body, const Points& reference) {
  const State& state = snapshot.state();
  const Dofs& acceleration = snapshot.accelerations();
  if (body.kind == BodyKind::compliant) return nodal_values(snapshot.model(), body, acceleration);
  const double *q = rigid_values(body, state.position), *a = rigid_values(body, acceleration);
  const double spin = rigid_values(body, state.reduced_momentum)[2];
  Points points = positions_at(snapshot, body, reference);
  for (Vec2& p : points) {
    const Vec2 arm = p - Vec2(q[0], q[1]);
    p = Vec2(a[0], a[1]) + a[2] * turned_left(arm) - spin * spin * arm;
  }
  return points;
}

}  // namespace pliant
