#include "bodies/update_outlines.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace pliant {
namespace {

void extend_cyclically(const OutlineShape& shape, double* x, double* y) {
  for (int i = shape.count; i < shape.count + lane_count; ++i) {
    x[i] = x[i - shape.count] + shape.turn_shift;
    y[i] = y[i - shape.count];
  }
}

void update_batch(const Model& model, const Batch& batch, const Lanes* q, Outlines& outlines) {
  const CompliantShape& shape = model.shape_of(batch);
  const ShapeRows& rows = shape.space.outline_rows;
  const int* bodies = &model.groups[batch.group].bodies[batch.first];
  const int count = model.outlines[shape.outline].count;
  for (int first = 0; first < count; first += lane_count) {
    Lanes x[lane_count]{}, y[lane_count]{}, x_of_body[lane_count], y_of_body[lane_count];
    for (int k = first; k < std::min(first + lane_count, count); ++k) {
      Lanes sum_x = batch.centre_x, sum_y = batch.centre_y;
      for (int e = rows.start[k]; e < rows.start[k + 1]; ++e) {
        sum_x += rows.value[e] * q[2 * rows.node[e]];
        sum_y += rows.value[e] * q[2 * rows.node[e] + 1];
      }
      x[k - first] = sum_x;
      y[k - first] = sum_y;
    }
    transpose(x, x_of_body);
    transpose(y, y_of_body);
    for (int lane = 0; lane < batch.count; ++lane) {  // the last ones reach into the cyclic copies, which come after
      store(&outlines.x[outlines.offset[bodies[lane]] + first], x_of_body[lane]);
      store(&outlines.y[outlines.offset[bodies[lane]] + first], y_of_body[lane]);
    }
  }
  for (int lane = 0; lane < batch.count; ++lane) {
    const int offset = outlines.offset[bodies[lane]];
    extend_cyclically(model.outlines[shape.outline], &outlines.x[offset], &outlines.y[offset]);
  }
}

void update_rigid(const Model& model, const RigidBody& rigid, const double* position, Outlines& outlines) {
  const OutlineShape& shape = model.outlines[rigid.outline];
  const double c = std::cos(position[2]), s = std::sin(position[2]);
  double* x = &outlines.x[outlines.offset[rigid.body]];
  double* y = &outlines.y[outlines.offset[rigid.body]];
  for (int k = 0; k < shape.count; ++k) {
    const Vec2& p = shape.points[k];
    x[k] = position[0] + (c * p.x() - s * p.y());
    y[k] = position[1] + (s * p.x() + c * p.y());
  }
  extend_cyclically(shape, x, y);
}

}  // namespace

Outlines make_outlines(const Model& model) {
  Outlines outlines;
  int next = 0;
  for (const Body& body : model.bodies) {
    outlines.shape.push_back(body.outline);
    outlines.offset.push_back(next);
    next += model.outlines[body.outline].count + lane_count;
  }
  outlines.offset.push_back(next);
  for (auto* array :
       {&outlines.x, &outlines.y, &outlines.force_x, &outlines.force_y, &outlines.x_refresh, &outlines.y_refresh})
    array->assign(static_cast<std::size_t>(next), 0.0);
  return outlines;
}

void update_outlines(const Model& model, const Dofs& positions, Outlines& outlines) {
  parallel_for(static_cast<int>(model.batches.size()), [&](int b) {
    update_batch(model, model.batches[b], &positions.compliant[model.batches[b].offset], outlines);
  });
  parallel_for(static_cast<int>(model.rigid_bodies.size()),
               [&](int r) { update_rigid(model, model.rigid_bodies[r], &positions.rigid[3 * r], outlines); });
}

void add_outline_forces(const Model& model, const Batch& batch, const Outlines& outlines, Lanes* forces) {
  const CompliantShape& shape = model.shape_of(batch);
  const ShapeRows& rows = shape.space.outline_rows;
  const int* bodies = &model.groups[batch.group].bodies[batch.first];
  const int count = model.outlines[shape.outline].count;
  for (int first = 0; first < count; first += lane_count) {
    Lanes x_of_body[lane_count]{}, y_of_body[lane_count]{}, fx[lane_count], fy[lane_count];
    for (int lane = 0; lane < batch.count; ++lane) {
      x_of_body[lane] = load(&outlines.force_x[outlines.offset[bodies[lane]] + first]);
      y_of_body[lane] = load(&outlines.force_y[outlines.offset[bodies[lane]] + first]);
    }
    transpose(x_of_body, fx);
    transpose(y_of_body, fy);
    for (int k = first; k < std::min(first + lane_count, count); ++k)
      for (int e = rows.start[k]; e < rows.start[k + 1]; ++e) {
        forces[2 * rows.node[e]] += rows.value[e] * fx[k - first];
        forces[2 * rows.node[e] + 1] += rows.value[e] * fy[k - first];
      }
  }
}

void outline_force_resultant(const Model& model, const RigidBody& rigid, const Outlines& outlines,
                             const double* position, double* resultant) {
  const int offset = outlines.offset[rigid.body];
  Lanes fx{}, fy{}, moment{};
  // The last lanes may reach into the cyclic copies, which carry no force.
  for (int i = offset; i < offset + model.outlines[rigid.outline].count; i += lane_count) {
    const Lanes nodal_x = load(&outlines.force_x[i]), nodal_y = load(&outlines.force_y[i]);
    fx += nodal_x;
    fy += nodal_y;
    moment += (load(&outlines.x[i]) - position[0]) * nodal_y - (load(&outlines.y[i]) - position[1]) * nodal_x;
  }
  resultant[0] = sum(fx);
  resultant[1] = sum(fy);
  resultant[2] = sum(moment);
}

}  // namespace pliant
