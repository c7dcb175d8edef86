#include "bodies/update_outlines.hpp"

#include "bodies/nodal.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

void compliant_velocities(const Model& model, const Body& body, const Dofs& velocity, double* x, double* y) {
  const Points nodal = outline_values(model, body, velocity);
  for (std::size_t k = 0; k < nodal.size(); ++k) x[k] = nodal[k].x(), y[k] = nodal[k].y();
}

void rigid_velocities(const Outlines& outlines, int offset, int count, const double* q, const double* v, double* x,
                      double* y) {
  for (int k = 0; k < count; ++k) {
    x[k] = v[0] - v[2] * (outlines.y[offset + k] - q[1]);
    y[k] = v[1] + v[2] * (outlines.x[offset + k] - q[0]);
  }
}

}  // namespace

void update_outline_velocities(const Model& model, const Motion& motion, Outlines& outlines) {
  if (!model.outline_rates) return;
  outlines.velocity_x.resize(outlines.x.size());
  outlines.velocity_y.resize(outlines.y.size());
  parallel_for(static_cast<int>(model.bodies.size()), [&](int b) {
    const Body& body = model.bodies[b];
    const int offset = outlines.offset[b], count = model.outlines[body.outline].count;
    double *x = &outlines.velocity_x[offset], *y = &outlines.velocity_y[offset];
    if (body.kind == BodyKind::compliant)
      compliant_velocities(model, body, motion.velocity, x, y);
    else
      rigid_velocities(outlines, offset, count, &motion.position.rigid[3 * static_cast<std::size_t>(body.rigid)],
                       &motion.velocity.rigid[3 * static_cast<std::size_t>(body.rigid)], x, y);
    for (int k = 0; k < lane_count; ++k) x[count + k] = x[k % count], y[count + k] = y[k % count];
  });
}

}  // namespace pliant
