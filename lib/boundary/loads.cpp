#include "boundary/loads.hpp"

#include "bodies/damping_forces.hpp"
#include "bodies/node_arrays.hpp"
#include "boundary/outline_loads.hpp"
#include "core/parallel.hpp"

namespace pliant {

namespace {

using Gravity = Eigen::Vector3d;  ///< along x, y and the angle, m/s2

Gravity gravity_of(const Vec2& g) { return {g.x(), g.y(), 0}; }
Gravity gravity_of(const Model& model, const Instant& at) { return gravity_of(model.scene.gravity_at(at.time)); }

/// Adds the change of the loads on a rigid body, its dashpots and gravity.
void add_rigid_load_change(const RigidBody& rigid, const Gravity& before, const Gravity& after, const Instant& from,
                           const Instant& to, const double* velocity, double* force) {
  for (int c = 0; c < 2; ++c) force[c] += rigid.dof[c].mass * (after[c] - before[c]);
  if (!rigid.driven) return;
  for (int c = 0; c < 3; ++c) {
    const RigidDof& dof = rigid.dof[c];
    force[c] += applied_load(dof, to, after[c]) - applied_load(dof, from, before[c]) -
                (damping_coefficient(dof, to) - damping_coefficient(dof, from)) * velocity[c];
  }
}

}  // namespace

double applied_load(const RigidDof& dof, const Instant& at, double g) {
  const bool servo = dof.mode == AxisCondition::Mode::pressure,
             loaded = servo || dof.mode == AxisCondition::Mode::force;
  if (!loaded || !contains(dof.window, at)) return 0;
  return dof.force_scale * dof.history.at(at.time) - (servo ? dof.mass * g : 0);
}

void add_gravity(const Model& model, const Region& region, const Vec2& g, Lanes* forces) {
  if (g.x() == 0 && g.y() == 0) return;
  const Batch& batch = model.batches[region.batch];
  // Padding lanes would fall without end, because nothing supports them.
  const Lanes density = select(batch.weight > 0.0, batch.density * batch.inverse_scale, Lanes{});
  with_nodes(model, batch, [&](const auto& nodes) {
    for (int i = region.first; i < region.last; ++i) {
      forces[2 * i] += density * (nodes.mass_at_unit_density[i] * g.x());
      forces[2 * i + 1] += density * (nodes.mass_at_unit_density[i] * g.y());
    }
  });
}

void add_rigid_loads(const RigidBody& rigid, const Vec2& g, const Instant& at, double* force) {
  force[0] += rigid.dof[0].mass * g.x();
  force[1] += rigid.dof[1].mass * g.y();
  if (!rigid.driven) return;
  for (int c = 0; c < 3; ++c) force[c] += applied_load(rigid.dof[c], at, gravity_of(g)[c]);
}

double add_load_change(const Model& model, const Motion& at, const Outlines& outlines, const Instant& to, Dofs& force) {
  const Gravity before = gravity_of(model, at.instant()), after = gravity_of(model, to);
  const Vec2 g = (after - before).head<2>();
  if (!g.isZero(0))
    parallel_for(static_cast<int>(model.regions.size()), [&](int r) {
      const Region& region = model.regions[r];
      add_gravity(model, region, g, &force.compliant[model.batches[region.batch].offset]);
    });
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    add_rigid_load_change(model.rigid_bodies[r], before, after, at.instant(), to, &at.velocity.rigid[3 * r],
                          &force.rigid[3 * r]);
  return add_outline_load_change(model, at, outlines, to, force);
}

double external_work(const Model& model, const Motion& before, const Dofs& force, const Motion& after,
                     const Dofs& next_force) {
  double work = 0;
  const Gravity g0 = gravity_of(model, before.instant()), g1 = gravity_of(model, after.instant());
  for (int r : model.driven) {
    const RigidBody& rigid = model.rigid_bodies[r];
    for (int c = 0; c < 3; ++c) {
      const std::size_t i = 3 * static_cast<std::size_t>(r) + static_cast<std::size_t>(c);
      const RigidDof& dof = rigid.dof[c];
      const double moved = after.position.rigid[i] - before.position.rigid[i];
      if (dof.imposed(before.time)) {
        const double v0 = before.velocity.rigid[i], v1 = after.velocity.rigid[i];
        work += 0.5 * dof.mass * (v1 * v1 - v0 * v0) - 0.5 * (force.rigid[i] + next_force.rigid[i]) * moved;
      } else {
        work += 0.5 * (applied_load(dof, before.instant(), g0[c]) + applied_load(dof, after.instant(), g1[c])) * moved;
      }
    }
  }
  return work;
}

namespace {

/// Gravity moment of slots [first, last).
Lanes gravity_moment(const Model& model, const Batch& batch, int first, int last, const Vec2& g, const Dofs& position) {
  const Lanes* q = &position.compliant[batch.offset];
  return with_nodes(model, batch, [&](const auto& nodes) {
    Lanes moment{};
    for (int i = first; i < last; ++i)
      moment += nodes.mass_at_unit_density[i] * (g.x() * q[2 * i] + g.y() * q[2 * i + 1]);
    return moment * batch.density * batch.inverse_scale * batch.weight;
  });
}

}  // namespace

Lanes gravity_moment(const Model& model, const Batch& batch, const Vec2& g, const Dofs& position) {
  if (g.x() == 0 && g.y() == 0) return Lanes{};
  return gravity_moment(model, batch, 0, batch.slots, g, position);
}

double gravity_moment(const Model& model, const Vec2& g, const Dofs& position) {
  if (g.x() == 0 && g.y() == 0) return 0;
  double total = ordered_sum(static_cast<int>(model.regions.size()), [&](int r) {
    const Region& region = model.regions[r];
    const Batch& batch = model.batches[region.batch];
    return sum(gravity_moment(model, batch, region.first, region.last, g, position));
  });
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    for (int c = 0; c < 2; ++c)
      total += model.rigid_bodies[r].dof[c].mass * g[c] * position.rigid[3 * r + static_cast<std::size_t>(c)];
  return total;
}

double gravity_work(const Model& model, const Motion& before, const Motion& after) {
  if (model.scene.gravity_history.empty()) return 0;
  const Vec2 mean = 0.5 * (model.scene.gravity_at(before.time) + model.scene.gravity_at(after.time));
  return gravity_moment(model, mean, after.position) - gravity_moment(model, mean, before.position);
}

}  // namespace pliant
