#include "bodies/update_outlines.hpp"

#include <algorithm>
#include <cmath>

#include "bodies/body_view.hpp"
#include "bodies/node_arrays.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

void extend_cyclically(const OutlineShape& shape, double* x, double* y) {
  for (int i = shape.count; i < shape.count + lane_count; ++i) {
    x[i] = x[i - shape.count] + shape.turn_shift;
    y[i] = y[i - shape.count];
  }
}

template <bool scaled, class Rows>
void update_batch(const Model& model, const Batch& batch, const Rows& rows, const Lanes* q, Outlines& outlines) {
  const CompliantShape& shape = model.shape_of(batch);
  const int* bodies = &model.groups[batch.group].bodies[batch.first];
  const int count = model.outlines[shape.outline].count;
  const Lanes centre_x = batch.centre_x * batch.inverse_scale, centre_y = batch.centre_y * batch.inverse_scale;
  for (int first = 0; first < count; first += lane_count) {
    Lanes x[lane_count]{}, y[lane_count]{}, x_of_body[lane_count], y_of_body[lane_count];
    for (int k = first; k < std::min(first + lane_count, count); ++k) {
      Lanes sum_x = centre_x, sum_y = centre_y;
      for (int e = rows.start[k]; e < rows.start[k + 1]; ++e) {
        sum_x += rows.value[e] * q[2 * rows.node[e]];
        sum_y += rows.value[e] * q[2 * rows.node[e] + 1];
      }
      x[k - first] = sum_x;
      y[k - first] = sum_y;
    }
    if constexpr (scaled)
      for (int k = 0; k < lane_count; ++k) x[k] *= batch.scale, y[k] *= batch.scale;
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

/// One chunk of a spread body's outline nodes.
void update_chunk(const Model& model, const Chunk& chunk, const Dofs& positions, Outlines& outlines) {
  const Batch& batch = model.batches[chunk.batch];
  const int number = model.groups[batch.group].bodies[batch.first];
  const Body& body = model.bodies[number];
  const ShapeRows& rows = model.shape_of(body).space.outline_rows;
  const BodyView q(model, body, positions);
  for (int k = chunk.first; k < chunk.last; ++k) {
    Vec2 x(0, 0);
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e)
      x += rows.value[e] * q[static_cast<std::size_t>(rows.node[e])];
    x = body.centre + body.scale * x;
    outlines.x[outlines.offset[number] + k] = x.x();
    outlines.y[outlines.offset[number] + k] = x.y();
  }
}

void update_spread(const Model& model, const Dofs& positions, Outlines& outlines) {
  parallel_for(static_cast<int>(model.outline_chunks.size()),
               [&](int c) { update_chunk(model, model.outline_chunks[c], positions, outlines); });
  for (std::size_t b = static_cast<std::size_t>(model.lane_batches); b < model.batches.size(); ++b) {
    const int body = model.groups[model.batches[b].group].bodies[model.batches[b].first];
    const int offset = outlines.offset[body];
    extend_cyclically(model.outlines[outlines.shape[body]], &outlines.x[offset], &outlines.y[offset]);
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

template <bool scaled, class Rows>
void add_to_lanes(const Model& model, const Batch& batch, const Rows& rows, const Outlines& outlines, Lanes* forces) {
  const CompliantShape& shape = model.shape_of(batch);
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
    if constexpr (scaled)
      for (int k = 0; k < lane_count; ++k) fx[k] *= batch.inverse_scale, fy[k] *= batch.inverse_scale;
    for (int k = first; k < std::min(first + lane_count, count); ++k)
      for (int e = rows.start[k]; e < rows.start[k + 1]; ++e) {
        forces[2 * rows.node[e]] += rows.value[e] * fx[k - first];
        forces[2 * rows.node[e] + 1] += rows.value[e] * fy[k - first];
      }
  }
}

void add_to_region(const Model& model, const Region& region, const Outlines& outlines, Lanes* forces) {
  const Batch& batch = model.batches[region.batch];
  const SpreadShape& shape = model.spread_shape_of(batch);
  const int offset = outlines.offset[model.groups[batch.group].bodies[batch.first]];
  const double inverse_scale = batch.inverse_scale[0];
  double* f = reinterpret_cast<double*>(forces);
  for (int e = shape.outline_start[region.number]; e < shape.outline_start[region.number + 1]; ++e) {
    const SpreadShape::OutlineEntry& entry = shape.outline_entries[e];
    f[entry.node] += entry.value * inverse_scale * outlines.force_x[offset + entry.outline];
    f[entry.node + lane_count] += entry.value * inverse_scale * outlines.force_y[offset + entry.outline];
  }
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
  parallel_for(model.lane_batches, [&](int b) {
    const Batch& batch = model.batches[b];
    const Lanes* q = &positions.compliant[batch.offset];
    with_tables(model, batch, [&](const auto& tables) {
      batch.scaled ? update_batch<true>(model, batch, tables.outline_rows, q, outlines)
                   : update_batch<false>(model, batch, tables.outline_rows, q, outlines);
    });
  });
  if (!model.outline_chunks.empty()) update_spread(model, positions, outlines);
  parallel_for(static_cast<int>(model.rigid_bodies.size()),
               [&](int r) { update_rigid(model, model.rigid_bodies[r], &positions.rigid[3 * r], outlines); });
}

void add_outline_forces(const Model& model, const Region& region, const Outlines& outlines, Lanes* forces) {
  const Batch& batch = model.batches[region.batch];
  if (batch.layout == Layout::spread) return add_to_region(model, region, outlines, forces);
  with_tables(model, batch, [&](const auto& tables) {
    batch.scaled ? add_to_lanes<true>(model, batch, tables.outline_rows, outlines, forces)
                 : add_to_lanes<false>(model, batch, tables.outline_rows, outlines, forces);
  });
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
