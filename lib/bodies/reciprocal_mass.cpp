#include "bodies/reciprocal_mass.hpp"

#include "bodies/node_arrays.hpp"

namespace pliant {

namespace {

/// [x, y] sums of eight bodies, one per lane; Rows: ShapeRows or LaneRows.
template <class Rows>
void multiply_lanes(const Rows& rows, int node, const Lanes* y, Lanes* v) {
  Lanes x_sum{}, y_sum{};
  for (int e = rows.start[node]; e < rows.start[node + 1]; ++e) {
    x_sum += rows.value[e] * y[2 * rows.node[e]];
    y_sum += rows.value[e] * y[2 * rows.node[e] + 1];
  }
  v[2 * node] = x_sum;
  v[2 * node + 1] = y_sum;
}

/// The same for one body, whose nodes are at `offset`.
void multiply_nodewise(const ShapeRows& rows, int node, const int* offset, const double* y, double* v) {
  double x_sum = 0, y_sum = 0;
  for (int e = rows.start[node]; e < rows.start[node + 1]; ++e) {
    x_sum += rows.value[e] * y[offset[rows.node[e]]];
    y_sum += rows.value[e] * y[offset[rows.node[e]] + lane_count];
  }
  v[offset[node]] = x_sum;
  v[offset[node] + lane_count] = y_sum;
}

/// Sparse product of one batch; rows_of: of its tables.
template <class RowsOf>
void multiply(const Model& model, const Batch& batch, const RowsOf& rows_of, const Lanes* y, Lanes* v) {
  const CompliantShape& shape = model.shape_of(batch);
  if (batch.layout != Layout::nodewise)
    return with_tables(model, batch, [&](const auto& tables) {
      for (int i = 0; i < shape.nodes(); ++i) multiply_lanes(rows_of(tables), i, y, v);
    });
  const ShapeRows& rows = rows_of(shape.space);
  v[2 * batch.slots - 2] = v[2 * batch.slots - 1] = Lanes{};  // padding
  const int* offset = model.nodewise_shape_of(batch).offset.data();
  parallel_for(shape.nodes(), [&](int i) {
    multiply_nodewise(rows, i, offset, reinterpret_cast<const double*>(y), reinterpret_cast<double*>(v));
  });
}

}  // namespace

void apply_reciprocal_mass(const Model& model, const Batch& batch, const Lanes* y, Lanes* v) {
  multiply(model, batch, [](const auto& tables) -> const auto& { return tables.reciprocal_mass; }, y, v);
}

void apply_relative_mass(const Model& model, const Batch& batch, const Lanes* v, Lanes* y) {
  multiply(model, batch, [](const auto& tables) -> const auto& { return tables.relative_mass; }, v, y);
}

const Dofs& material_velocity(const Model& model, const Dofs& y, Dofs& scratch) {
  if (!model.has_reciprocal_mass) return y;
  scratch = y;
  for_each_batch(model, [&](int b) {
    const Batch& batch = model.batches[b];
    apply_reciprocal_mass(model, batch, &y.compliant[batch.offset], &scratch.compliant[batch.offset]);
  });
  return scratch;
}

Dofs material_velocity(const Model& model, const Dofs& y) {
  Dofs scratch;
  return material_velocity(model, y, scratch);
}

Dofs reduced_momentum(const Model& model, const Dofs& velocity) {
  Dofs y = velocity;
  if (!model.has_reciprocal_mass) return y;
  if (model.scene.discretisation.mass == Mass::lumped) {
    for_each_batch(model, [&](int b) {
      const Batch& batch = model.batches[b];
      apply_relative_mass(model, batch, &velocity.compliant[batch.offset], &y.compliant[batch.offset]);
    });
    return y;
  }
  // The eigenvalues of C are in [1, 2], so each step of y += 2/3 (v - C y) leaves at most a third of the error.
  constexpr int steps = 40;
  for (int step = 0; step < steps; ++step) {
    const Dofs reached = material_velocity(model, y);
    for (std::size_t i = 0; i < y.compliant.size(); ++i)
      y.compliant[i] += 2.0 / 3 * (velocity.compliant[i] - reached.compliant[i]);
  }
  return y;
}

}  // namespace pliant
