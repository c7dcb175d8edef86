#include "bodies/place_outlines.hpp"

#include <algorithm>
#include <cmath>

#include "bodies/body_view.hpp"
#include "bodies/node_arrays.hpp"
#include "bodies/own_bodies.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Field of compliant bodies: positions, relative to their bodies' centres, or a field without origin.
struct FieldOfBodies {
  const Dofs& values;
  bool has_origin;
};

template <bool scaled, class Rows>
void show_batch(const Model& model, const Batch& batch, const Rows& rows, const FieldOfBodies& field,
                OutlineField& outlines) {
  const CompliantShape& shape = model.shape_of(batch);
  const Lanes* q = &field.values.compliant[batch.offset];
  const int* bodies = &model.groups[batch.group].bodies[batch.first];
  const int count = model.outlines[shape.outline].count;
  const Lanes inverse_scale = field.has_origin ? batch.inverse_scale : Lanes{};
  const Lanes centre_x = batch.centre_x * inverse_scale, centre_y = batch.centre_y * inverse_scale;
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
    for (int lane = 0; lane < batch.count;
         ++lane) {  // the last lanes reach into the cyclic copies, which are set later
      store(&outlines.x[model.outline_offset[bodies[lane]] + first], x_of_body[lane]);
      store(&outlines.y[model.outline_offset[bodies[lane]] + first], y_of_body[lane]);
    }
  }
  for (int lane = 0; lane < batch.count; ++lane) {
    const int offset = model.outline_offset[bodies[lane]];
    extend_cyclically(model.outlines[shape.outline], &outlines.x[offset], &outlines.y[offset]);
  }
}

/// Computes one chunk of a nodewise body's outline nodes.
void show_chunk(const Model& model, const Chunk& chunk, const FieldOfBodies& field, OutlineField& outlines) {
  const Batch& batch = model.batches[chunk.batch];
  const int number = model.groups[batch.group].bodies[batch.first];
  const Body& body = model.bodies[number];
  const ShapeRows& rows = model.shape_of(body).space.outline_rows;
  const BodyView q(model, body, field.values);
  const Vec2 origin = field.has_origin ? body.centre : Vec2(0, 0);
  for (int k = chunk.first; k < chunk.last; ++k) {
    Vec2 x(0, 0);
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e)
      x += rows.value[e] * q[static_cast<std::size_t>(rows.node[e])];
    x = origin + body.scale * x;
    outlines.x[model.outline_offset[number] + k] = x.x();
    outlines.y[model.outline_offset[number] + k] = x.y();
  }
}

void update_nodewise_outlines(const Model& model, const FieldOfBodies& field, OutlineField& outlines) {
  parallel_for(static_cast<int>(model.outline_chunks.size()),
               [&](int c) { show_chunk(model, model.outline_chunks[c], field, outlines); });
  for (std::size_t b = static_cast<std::size_t>(model.lane_batches); b < model.batches.size(); ++b) {
    const int body = model.groups[model.batches[b].group].bodies[model.batches[b].first];
    const int offset = model.outline_offset[body];
    extend_cyclically(model.outline_of(body), &outlines.x[offset], &outlines.y[offset]);
  }
}

/// Computes a field at the outline nodes of some compliant bodies, and calls of_rigid(r) for the first `rigid` of their
/// rigid bodies.
template <class OfRigid>
void show(const Model& model, const OwnBodies& bodies, const FieldOfBodies& field, OutlineField& outlines,
          std::size_t rigid, OfRigid&& of_rigid) {
  const auto of_batch = [&](int number) {
    const Batch& batch = model.batches[bodies.batches[number]];
    with_tables(model, batch, [&](const auto& tables) {
      batch.scaled ? show_batch<true>(model, batch, tables.outline_rows, field, outlines)
                   : show_batch<false>(model, batch, tables.outline_rows, field, outlines);
    });
  };
  parallel_for(bodies.lane_batches, of_batch, static_cast<int>(rigid),
               [&](int number) { of_rigid(bodies.rigid_bodies[number]); });
  if (!model.outline_chunks.empty()) update_nodewise_outlines(model, field, outlines);
}

/// Computes the positions of the outlines of some bodies.
void place(const Model& model, const OwnBodies& bodies, const Dofs& positions, OutlineField& position) {
  position.lattice = positions.lattice;
  show(model, bodies, {positions, true}, position, bodies.rigid_bodies.size(), [&](int r) {
    place_rigid_outline(model, model.rigid_bodies[r], &positions.rigid[3 * static_cast<std::size_t>(r)], position);
  });
}

template <bool scaled, class Rows>
void add_to_lanes(const Model& model, const Batch& batch, const Rows& rows, const OutlineField& on_outlines,
                  Lanes* forces) {
  const CompliantShape& shape = model.shape_of(batch);
  const int* bodies = &model.groups[batch.group].bodies[batch.first];
  const int count = model.outlines[shape.outline].count;
  for (int first = 0; first < count; first += lane_count) {
    Lanes x_of_body[lane_count]{}, y_of_body[lane_count]{}, fx[lane_count], fy[lane_count];
    for (int lane = 0; lane < batch.count; ++lane) {
      x_of_body[lane] = load(&on_outlines.x[model.outline_offset[bodies[lane]] + first]);
      y_of_body[lane] = load(&on_outlines.y[model.outline_offset[bodies[lane]] + first]);
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

void add_to_region(const Model& model, const Region& region, const OutlineField& on_outlines, Lanes* forces) {
  const Batch& batch = model.batches[region.batch];
  const NodewiseShape& shape = model.nodewise_shape_of(batch);
  const int offset = model.outline_offset[model.groups[batch.group].bodies[batch.first]];
  const double inverse_scale = batch.inverse_scale[0];
  double* f = reinterpret_cast<double*>(forces);
  for (int e = shape.outline_start[region.number]; e < shape.outline_start[region.number + 1]; ++e) {
    const NodewiseShape::OutlineEntry& entry = shape.outline_entries[e];
    f[entry.node] += entry.value * inverse_scale * on_outlines.x[offset + entry.outline];
    f[entry.node + lane_count] += entry.value * inverse_scale * on_outlines.y[offset + entry.outline];
  }
}

}  // namespace

void extend_cyclically(const OutlineShape& shape, double* x, double* y) {
  for (int i = shape.count; i < shape.count + lane_count; ++i) {
    x[i] = x[i - shape.count] + shape.turn_shift;
    y[i] = y[i - shape.count];
  }
}

void place_rigid_outline(const Model& model, const RigidBody& rigid, const double* position, OutlineField& outlines) {
  const OutlineShape& shape = model.outlines[rigid.outline];
  const double c = std::cos(position[2]), s = std::sin(position[2]);
  double* x = &outlines.x[model.outline_offset[rigid.body]];
  double* y = &outlines.y[model.outline_offset[rigid.body]];
  for (int k = 0; k < shape.count; ++k) {
    const Vec2& p = shape.points[k];
    x[k] = position[0] + (c * p.x() - s * p.y());
    y[k] = position[1] + (s * p.x() + c * p.y());
  }
  extend_cyclically(shape, x, y);
}

void place_outlines(const Model& model, const Dofs& positions, OutlineField& position) {
  place(model, model.own, positions, position);
}

void update_outline_field(const Model& model, const Dofs& values, OutlineField& field) {
  field.lattice = values.lattice;
  show(model, model.own, {values, false}, field, 0, [](int) {});
}

OutlineField placed_outlines(const Model& model, const Dofs& positions) {
  OutlineField position(model.outline_offset.back());
  place(model, all_bodies(model), positions, position);
  return position;
}

void add_outline_forces(const Model& model, const Region& region, const OutlineField& on_outlines, Lanes* forces) {
  const Batch& batch = model.batches[region.batch];
  if (batch.layout == Layout::nodewise) return add_to_region(model, region, on_outlines, forces);
  with_tables(model, batch, [&](const auto& tables) {
    batch.scaled ? add_to_lanes<true>(model, batch, tables.outline_rows, on_outlines, forces)
                 : add_to_lanes<false>(model, batch, tables.outline_rows, on_outlines, forces);
  });
}

void outline_force_resultant(const Model& model, const RigidBody& rigid, const OutlineField& outlines,
                             const OutlineField& on_outlines, const double* position, double* resultant) {
  const int offset = model.outline_offset[rigid.body];
  Lanes fx{}, fy{}, moment{};
  // The last lanes may reach into the cyclic copies, which carry no force.
  for (int i = offset; i < offset + model.outlines[rigid.outline].count; i += lane_count) {
    const Lanes nodal_x = load(&on_outlines.x[i]), nodal_y = load(&on_outlines.y[i]);
    fx += nodal_x;
    fy += nodal_y;
    moment += (load(&outlines.x[i]) - position[0]) * nodal_y - (load(&outlines.y[i]) - position[1]) * nodal_x;
  }
  resultant[0] = sum(fx);
  resultant[1] = sum(fy);
  resultant[2] = sum(moment);
}

}  // namespace pliant
