#include "reference/outputs/view.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "reference/cell_motion.hpp"

namespace pliant::reference {
namespace {

/// Nodes of a rigid body, rotated about its centre.
Points turned(const Body& body, const Vec2& centre, double angle) {
  Points points;
  for (const Vec2& p : body.outline) points.push_back(centre + Eigen::Rotation2Dd(angle) * p);
  return points;
}

}  // namespace

Vec2 View::mean(const Body& body, const Vector& values) const { return centre_of(bodies(), body, values); }

Points View::at_nodes(const Body& body, const Vector& values) const {
  Points points;
  for (const Row& row : bodies().space_of(body).nodes) points.push_back(interpolated(row, values, body.first_dof));
  return points;
}

Points View::positions_of(const Body& body) const {
  if (body.compliant()) return at_nodes(body, positions());
  return turned(body, positions().segment<2>(body.first_dof), positions()[body.first_dof + 2]);
}

Points View::start_of(const Body& body) const {
  if (!body.compliant()) return turned(body, body.placed.centre, body.placed.angle);
  Points points;
  for (const Vec2& node : bodies().space_of(body).mesh.nodes)
    points.push_back(body.placed.centre + Eigen::Rotation2Dd(body.placed.angle) * (body.placed.scale * node));
  return points;
}

Points View::velocities_of(const Body& body) const {
  if (body.compliant()) return at_nodes(body, velocities());
  const Eigen::Vector3d v = velocities().segment<3>(body.first_dof);
  Points points = positions_of(body);
  for (Vec2& p : points) p = v.head<2>() + v[2] * turned_left(p - positions().segment<2>(body.first_dof));
  return points;
}

Points View::accelerations_of(const Body& body) const {
  if (body.compliant()) return at_nodes(body, accelerations());
  const Eigen::Vector3d a = accelerations().segment<3>(body.first_dof);
  const double spin = velocities()[body.first_dof + 2];
  Points points = positions_of(body);
  for (Vec2& p : points) {
    const Vec2 arm = p - positions().segment<2>(body.first_dof);
    p = a.head<2>() + a[2] * turned_left(arm) - spin * spin * arm;
  }
  return points;
}

const InternalForces& View::internal_of(const Body& body) const {
  std::size_t number = 0;
  for (const Body& other : bodies().all()) {
    if (&other == &body) break;
    number += other.compliant();
  }
  return system_.internal()[number];
}

std::vector<PointStress> View::stresses_of(const Body& body) const {
  return internal_of(body).stresses(positions().segment(body.first_dof, body.dofs));
}

const Vector& View::weights_of(const Body& body) const { return internal_of(body).weights(); }

Points View::contact_forces() const {
  Points sum = forces_on_nodes(this->forces().contacts, static_cast<std::size_t>(bodies().outline_nodes()));
  add_forces(this->forces().bonds, sum);
  return sum;
}

double View::kinetic_energy(const Body& body) const {
  Vector own = Vector::Zero(bodies().dofs());
  own.segment(body.first_dof, body.dofs) = velocities().segment(body.first_dof, body.dofs);
  return 0.5 * own.dot(run_.mass() * own);
}

double von_mises(const PointStress& s) {
  return std::sqrt(0.5 * (std::pow(s.xx - s.yy, 2) + std::pow(s.yy - s.zz, 2) + std::pow(s.zz - s.xx, 2)) +
                   3 * s.xy * s.xy);
}

}  // namespace pliant::reference
