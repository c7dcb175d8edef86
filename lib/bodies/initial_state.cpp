#include "bodies/initial_state.hpp"

#include "bodies/mass_correction.hpp"

#include <cmath>

namespace pliant {

Dofs zero_dofs(const Model& model) { return Dofs(model.compliant_size, 3 * model.rigid_bodies.size()); }

Dofs initial_positions(const Model& model) {
  Dofs q = zero_dofs(model);
  for (const Batch& batch : model.batches) {
    const Points& nodes = model.shape_of(batch).space.mesh.nodes;
    const std::vector<int>& members = model.groups[batch.group].bodies;
    for (int lane = 0; lane < lane_count; ++lane) {
      const double angle = model.bodies[members[batch.first + std::min(lane, batch.count - 1)]].angle;
      const double c = std::cos(angle), s = std::sin(angle);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        q.compliant[batch.offset + 2 * i][lane] = c * nodes[i].x() - s * nodes[i].y();
        q.compliant[batch.offset + 2 * i + 1][lane] = s * nodes[i].x() + c * nodes[i].y();
      }
    }
  }
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r) {
    const Body& body = model.bodies[model.rigid_bodies[r].body];
    q.rigid[3 * r] = body.centre.x();
    q.rigid[3 * r + 1] = body.centre.y();
    q.rigid[3 * r + 2] = body.angle;
  }
  return q;
}

Dofs initial_velocities(const Model& model, const Dofs& q) {
  Dofs v = zero_dofs(model);
  for (const Batch& batch : model.batches) {
    const std::vector<int>& members = model.groups[batch.group].bodies;
    const int nodes = model.shape_of(batch).nodes();
    for (int lane = 0; lane < batch.count; ++lane) {
      const InitialVelocity& field = model.scene.grains[model.bodies[members[batch.first + lane]].grains].velocity;
      for (int i = 0; i < nodes; ++i) {
        const std::size_t at = batch.offset + 2 * static_cast<std::size_t>(i);
        const Vec2 r(q.compliant[at][lane], q.compliant[at + 1][lane]);
        const Vec2 velocity = field.uniform + field.rotation * Vec2(-r.y(), r.x()) + field.gradient * r;
        v.compliant[at][lane] = velocity.x();
        v.compliant[at + 1][lane] = velocity.y();
      }
    }
  }
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r) {
    const RigidBody& rigid = model.rigid_bodies[r];
    if (const Body& body = model.bodies[rigid.body]; !body.wall) {
      const InitialVelocity& field = model.scene.grains[body.grains].velocity;
      v.rigid[3 * r] = field.uniform.x(), v.rigid[3 * r + 1] = field.uniform.y(), v.rigid[3 * r + 2] = field.rotation;
    }
    for (int c = 0; c < 3; ++c)
      if (rigid.dof[c].mode == Drive::Mode::velocity) v.rigid[3 * r + c] = rigid.dof[c].history.at(0);
  }
  return reduced_momentum(model, v);
}

}  // namespace pliant
