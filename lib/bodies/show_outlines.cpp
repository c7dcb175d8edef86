#include <cmath>

#include "bodies/nodal.hpp"
#include "bodies/place_outlines.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

void compliant_velocities(const Model& model, const Body& body, const Dofs& velocity, double* x, double* y) {
  const Points nodal = outline_values(model, body, velocity);
  for (std::size_t k = 0; k < nodal.size(); ++k) x[k] = nodal[k].x(), y[k] = nodal[k].y();
}

void rigid_velocities(const OutlineField& position, int offset, int count, const double* q, const double* v, double* x,
                      double* y) {
  for (int k = 0; k < count; ++k) {
    x[k] = v[0] - v[2] * (position.y[offset + k] - q[1]);
    y[k] = v[1] + v[2] * (position.x[offset + k] - q[0]);
  }
}

void find_velocities(const Model& model, const Motion& motion, Outlines& outlines) {
  OutlineField& velocity = outlines.velocity;
  velocity.x.resize(outlines.position.x.size());
  velocity.y.resize(outlines.position.x.size());
  parallel_for(static_cast<int>(model.bodies.size()), [&](int b) {
    const Body& body = model.bodies[b];
    const int offset = model.outline_offset[b], count = model.outlines[body.outline].count;
    double *x = &velocity.x[offset], *y = &velocity.y[offset];
    if (body.kind == BodyKind::compliant)
      compliant_velocities(model, body, motion.velocity, x, y);
    else
      rigid_velocities(outlines.position, offset, count,
                       &motion.position.rigid[3 * static_cast<std::size_t>(body.rigid)],
                       &motion.velocity.rigid[3 * static_cast<std::size_t>(body.rigid)], x, y);
    for (int k = 0; k < lane_count; ++k) x[count + k] = x[k % count], y[count + k] = y[k % count];
  });
}

/// Half of the two segments beside each node, as they are now.
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

void show_outlines(const Model& model, const Motion& motion, Outlines& outlines) {
  outlines.position.x.resize(static_cast<std::size_t>(model.outline_offset.back()));
  outlines.position.y.resize(static_cast<std::size_t>(model.outline_offset.back()));
  place_outlines(model, motion.position, outlines.position);
  if (model.outline_rates) find_velocities(model, motion, outlines);
  if (model.scene.contact.length == ContactLength::current) measure_lengths(model, outlines);
}

}  // namespace pliant
