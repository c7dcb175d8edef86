#include "bodies/mass_correction.hpp"

#include <algorithm>
#include <limits>

#include "bodies/node_arrays.hpp"

namespace pliant {

namespace {

/// [x, y] sums of eight bodies, one per lane; Rows: ShapeRows or LaneRows.
template <class Rows>
void correct_lanes(const Rows& rows, int node, const Lanes* y, Lanes* v) {
  Lanes x_sum{}, y_sum{};
  for (int e = rows.start[node]; e < rows.start[node + 1]; ++e) {
    x_sum += rows.value[e] * y[2 * rows.node[e]];
    y_sum += rows.value[e] * y[2 * rows.node[e] + 1];
  }
  v[2 * node] = x_sum;
  v[2 * node + 1] = y_sum;
}

/// The same for one body, whose nodes are at `offset`.
void correct_nodewise(const ShapeRows& rows, int node, const int* offset, const double* y, double* v) {
  double x_sum = 0, y_sum = 0;
  for (int e = rows.start[node]; e < rows.start[node + 1]; ++e) {
    x_sum += rows.value[e] * y[offset[rows.node[e]]];
    y_sum += rows.value[e] * y[offset[rows.node[e]] + lane_count];
  }
  v[offset[node]] = x_sum;
  v[offset[node] + lane_count] = y_sum;
}

}  // namespace

void correct_velocity(const Model& model, const Batch& batch, const Lanes* y, Lanes* v) {
  const CompliantShape& shape = model.shape_of(batch);
  if (batch.layout != Layout::nodewise)
    return with_tables(model, batch, [&](const auto& tables) {
      for (int i = 0; i < shape.nodes(); ++i) correct_lanes(tables.mass_correction, i, y, v);
    });
  const ShapeRows& rows = shape.space.mass_correction;
  v[2 * batch.slots - 2] = v[2 * batch.slots - 1] = Lanes{};  // padding
  const int* offset = model.nodewise_shape_of(batch).offset.data();
  parallel_for(shape.nodes(), [&](int i) {
    correct_nodewise(rows, i, offset, reinterpret_cast<const double*>(y), reinterpret_cast<double*>(v));
  });
}

const Dofs& material_velocity(const Model& model, const Dofs& y, Dofs& scratch) {
  if (!model.corrected_mass) return y;
  scratch = y;
  for_each_batch(model, [&](int b) {
    const Batch& batch = model.batches[b];
    correct_velocity(model, batch, &y.compliant[batch.offset], &scratch.compliant[batch.offset]);
  });
  return scratch;
}

Dofs material_velocity(const Model& model, const Dofs& y) {
  Dofs scratch;
  return material_velocity(model, y, scratch);
}

Dofs reduced_momentum(const Model& model, const Dofs& velocity) {
  Dofs y = velocity;
  if (!model.corrected_mass) return y;
  double bound = 1;  // of the eigenvalues of C: each step of y += (v - C y) / bound leaves less of the error
  for (const CompliantShape& shape : model.shapes) bound = std::max(bound, shape.space.correction_bound);
  constexpr int most_steps = 10'000;
  Lanes least = broadcast(std::numeric_limits<double>::infinity());
  for (int step = 0; step < most_steps; ++step) {
    const Dofs reached = material_velocity(model, y);
    Lanes error{};
    for (std::size_t i = 0; i < y.compliant.size(); ++i) {
      const Lanes change = (velocity.compliant[i] - reached.compliant[i]) / bound;
      y.compliant[i] += change;
      error += change * change;
    }
    if (!any(error < least)) break;  // down to rounding in all lanes
    least = min(least, error);
  }
  return y;
}

}  // namespace pliant
