#include "bodies/initial_state.hpp"

#include "bodies/reciprocal_mass.hpp"

#include <cmath>

#include "bodies/body_view.hpp"

namespace pliant {

Dofs zero_dofs(const Model& model) { return Dofs(model.compliant_size, 3 * model.rigid_bodies.size()); }

void fill_padding(const Model& model, Dofs& q) {
  for (int b = 0; b < model.lane_batches; ++b) {
    const Batch& batch = model.batches[b];
    for (std::size_t i = batch.offset; i < batch.offset + 2 * static_cast<std::size_t>(batch.slots); ++i)
      for (int lane = batch.count; lane < lane_count; ++lane) q.compliant[i][lane] = q.compliant[i][batch.count - 1];
  }
}

Dofs initial_positions(const Model& model) {
  Dofs q = zero_dofs(model);
  q.lattice = initial_lattice(model.scene);
  for (const Body& body : model.bodies) {
    if (body.kind != BodyKind::compliant) continue;
    const Points& nodes = model.shape_of(body).space.mesh.nodes;
    const BodyOffsets offsets(model, body);
    const double c = std::cos(body.angle), s = std::sin(body.angle);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      set_node(offsets, i, {c * nodes[i].x() - s * nodes[i].y(), s * nodes[i].x() + c * nodes[i].y()}, q);
  }
  fill_padding(model, q);
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r) {
    const Body& body = model.bodies[model.rigid_bodies[r].body];
    q.rigid[3 * r] = body.centre.x();
    q.rigid[3 * r + 1] = body.centre.y();
    q.rigid[3 * r + 2] = body.angle;
  }
  return q;
}

void set_imposed_velocities(const Model& model, Dofs& v) {
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    for (std::size_t c = 0; c < 3; ++c)
      v.rigid[3 * r + c] = model.rigid_bodies[r].dof[c].velocity_after(0, 0, v.rigid[3 * r + c]);
}

Dofs initial_velocities(const Model& model, const Dofs& q) {
  Dofs v = zero_dofs(model);
  for (const Body& body : model.bodies) {
    if (body.kind != BodyKind::compliant) continue;
    const InitialVelocity& field = model.scene.grains[body.grains].velocity;
    const BodyOffsets offsets(model, body);
    const BodyView positions(model, body, q);
    for (int i = 0; i < model.shape_of(body).nodes(); ++i) {
      const Vec2 r = positions[static_cast<std::size_t>(i)] + body.offset / body.scale;
      const Vec2 velocity = field.uniform / body.scale + field.rotation * Vec2(-r.y(), r.x()) + field.gradient * r;
      set_node(offsets, static_cast<std::size_t>(i), velocity, v);
    }
  }
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r) {
    const RigidBody& rigid = model.rigid_bodies[r];
    if (const Body& body = model.bodies[rigid.body]; !body.wall) {
      const InitialVelocity& field = model.scene.grains[body.grains].velocity;
      v.rigid[3 * r] = field.uniform.x() - field.rotation * body.offset.y();
      v.rigid[3 * r + 1] = field.uniform.y() + field.rotation * body.offset.x();
      v.rigid[3 * r + 2] = field.rotation;
    }
  }
  set_imposed_velocities(model, v);
  return reduced_momentum(model, v);
}

}  // namespace pliant
