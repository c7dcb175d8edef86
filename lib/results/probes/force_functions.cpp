#include <cmath>
#include <limits>
#include <numeric>

#include "bodies/damping_forces.hpp"
#include "bodies/nodal.hpp"
#include "boundary/loads.hpp"
#include "boundary/outline_loads.hpp"
#include "results/body_motion.hpp"
#include "results/probes/probe_functions.hpp"

namespace pliant {
namespace {

// The force on one body, N/m, by origin. Their sum is the total force.

Vec2 contact_force(const Snapshot& snapshot, int b) {
  const int first = snapshot.model().outline_offset[b];
  Vec2 total(0, 0);
  for (int k = 0; k < snapshot.model().outline_of(b).count; ++k) total += snapshot.contact_force().at(first + k);
  return total;
}

Vec2 internal_force(const Snapshot& snapshot, int b) {
  const Points forces = dof_values(snapshot.model(), snapshot.model().bodies[b], snapshot.internal_forces());
  return std::accumulate(forces.begin(), forces.end(), Vec2(0, 0));
}

/// An imposed degree of freedom has a mass where its wall has a thickness.
Vec2 body_force(const Snapshot& snapshot, int b) {
  return snapshot.model().bodies[b].mass * snapshot.model().scene.gravity_at(snapshot.state().time);
}

Vec2 applied_force(const Snapshot& snapshot, int b) {
  const Body& body = snapshot.model().bodies[b];
  const Vec2 on_outline = outline_load(snapshot.model(), b, snapshot.state().outlines, {snapshot.state().time});
  if (body.kind == BodyKind::compliant) return on_outline;
  const RigidBody& rigid = snapshot.model().rigid_bodies[body.rigid];
  const Instant now = snapshot.motion().instant();
  const Vec2 g = snapshot.model().scene.gravity_at(now.time);
  return on_outline + Vec2(applied_load(rigid.dof[0], now, g.x()), applied_load(rigid.dof[1], now, g.y()));
}

/// Of the material and of dashpots beside loads; viscosity exerts no force on a body as a whole.
Vec2 damping_force(const Snapshot& snapshot, int b) {
  const Model& model = snapshot.model();
  const Body& body = model.bodies[b];
  const Motion motion = snapshot.motion();
  if (body.kind == BodyKind::compliant)
    return -model.scene.materials[body.material].mass_damping * body.mass * mean_value(model, body, motion.velocity);
  double force[3] = {0, 0, 0};
  add_rigid_damping(model.rigid_bodies[body.rigid], motion.instant(), rigid_values(body, motion.velocity), force);
  return {force[0], force[1]};
}

/// What an imposed motion needs beside all other forces: m a - f.
Vec2 reaction_force(const Snapshot& snapshot, int b) {
  const Body& body = snapshot.model().bodies[b];
  Vec2 reaction(0, 0);
  if (body.kind == BodyKind::compliant) return reaction;
  const RigidBody& rigid = snapshot.model().rigid_bodies[body.rigid];
  const double *a = rigid_values(body, snapshot.accelerations()), *f = rigid_values(body, snapshot.state().force);
  for (int c = 0; c < 2; ++c)
    if (rigid.dof[c].imposed(snapshot.state().time)) reaction[c] = rigid.dof[c].mass * a[c] - f[c];
  return reaction;
}

Vec2 total_force(const Snapshot& snapshot, int b) {
  const Body& body = snapshot.model().bodies[b];
  if (body.kind == BodyKind::compliant) {
    const Points forces = dof_values(snapshot.model(), body, snapshot.state().force);
    return std::accumulate(forces.begin(), forces.end(), Vec2(0, 0));
  }
  return mean_rate(snapshot.model(), body, snapshot.state().force) + reaction_force(snapshot, b);
}

Vec2 contact_force_at(const Snapshot& snapshot, int b, int node) {
  return snapshot.contact_force().at(snapshot.model().outline_offset[b] + node);
}

Vec2 internal_force_at(const Snapshot& snapshot, int b, int node) {
  return dof_values(snapshot.model(), snapshot.model().bodies[b], snapshot.internal_forces())[node];
}

template <auto of_body>
Samples forces(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(2);
  for (int b : selection.bodies) {
    const Vec2 force = of_body(snapshot, b);
    samples.add(1, {force.x(), force.y()});
  }
  return samples;
}

template <auto of_body, auto at_node>
Samples forces(const Snapshot& snapshot, const Selection& selection) {
  if (!selection.node) return forces<of_body>(snapshot, selection);
  Samples samples(2);
  const Vec2 force = at_node(snapshot, selection.bodies.front(), *selection.node);
  samples.add(1, {force.x(), force.y()});
  return samples;
}

Samples friction_factor(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(1);
  for (int b : selection.bodies) {
    const Vec2 f = contact_force(snapshot, b);
    samples.add(1, {f.y() != 0 ? f.x() / std::abs(f.y()) : std::numeric_limits<double>::quiet_NaN()});
  }
  return samples;
}

}  // namespace

std::vector<ProbeFunction> force_functions() {
  return {{"force", forces<contact_force, contact_force_at>},
          {"friction_factor", friction_factor},
          {"internal_force", forces<internal_force, internal_force_at>},
          {"body_force", forces<body_force>},
          {"applied_force", forces<applied_force>},
          {"damping_force", forces<damping_force>},
          {"reaction_force", forces<reaction_force>},
          {"total_force", forces<total_force>}};
}

}  // namespace pliant
