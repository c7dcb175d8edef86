#include <cmath>

#include "bodies/place_outlines.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Velocities of a rigid body's outline. `offset`: of its first node; q, v: [x, y, angle] of the body.
void rigid_velocities(const OutlineField& position, int offset, int count, const double* q, const double* v,
                      OutlineField& velocity) {
  for (int k = offset; k < offset + count + lane_count; ++k) {
    const int node = k < offset + count ? k : k - count;
    velocity.x[k] = v[0] - v[2] * (position.y[node] - q[1]);
    velocity.y[k] = v[1] + v[2] * (position.x[node] - q[0]);
  }
}

void find_velocities(const Model& model, const Motion& motion, Outlines& outlines) {
  OutlineField& velocity = outlines.velocity;
  velocity.x.resize(outlines.position.x.size());
  velocity.y.resize(outlines.position.x.size());
  update_outline_field(model, motion.velocity, velocity);
  parallel_for(static_cast<int>(model.rigid_bodies.size()), [&](int r) {
    const RigidBody& rigid = model.rigid_bodies[r];
    rigid_velocities(outlines.position, model.outline_offset[rigid.body], model.outlines[rigid.outline].count,
                     &motion.position.rigid[3 * r], &motion.velocity.rigid[3 * r], velocity);
  });
}

/// Computes current tributary lengths: half of the two segments at each node.
void measure_lengths(const Model& model, Outlines& outlines) {
  outlines.tributary_length.resize(outlines.position.x.size());
  parallel_for(static_cast<int>(model.bodies.size()), [&](int b) {
    const int offset = model.outline_offset[b], n = model.outline_of(b).count;
    const double *x = &outlines.position.x[offset], *y = &outlines.position.y[offset];
    double* length = &outlines.tributary_length[offset];
    double before = std::hypot(x[n] - x[n - 1], y[n] - y[n - 1]);
    for (int i = 0; i < n; ++i) {
      const double after = std::hypot(x[i + 1] - x[i], y[i + 1] - y[i]);
      length[i] = 0.5 * (before + after);
      before = after;
    }
    for (int i = 0; i < lane_count; ++i) length[n + i] = length[i % n];
  });
}

}  // namespace

void update_outlines(const Model& model, const Motion& motion, Outlines& outlines) {
  outlines.position.x.resize(static_cast<std::size_t>(model.outline_offset.back()));
  outlines.position.y.resize(static_cast<std::size_t>(model.outline_offset.back()));
  place_outlines(model, motion.position, outlines.position);
  if (model.outline_rates) find_velocities(model, motion, outlines);
  if (model.scene.contact.length == ContactLength::current) measure_lengths(model, outlines);
}

}  // namespace pliant
