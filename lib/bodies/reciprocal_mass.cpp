#include "bodies/reciprocal_mass.hpp"

#include <span>

#include <Eigen/LU>

#include "bodies/body_view.hpp"
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

/// y of one body with scaled mass. C has blocks: the nodes of a row are those of its block.
void solve_blocks(const Model& model, const Body& body, const Dofs& velocity, Dofs& y) {
  const ShapeRows& rows = model.shape_of(body).space.reciprocal_mass;
  const BodyOffsets offsets(model, body);
  const BodyView v(model, body, velocity);
  for (int i = 0; i + 1 < static_cast<int>(rows.start.size()); ++i) {
    const std::span<const int> block(&rows.node[rows.start[i]],
                                     &rows.node[rows.start[i]] + rows.start[i + 1] - rows.start[i]);
    if (i != block[0]) continue;  // one of each block
    const auto size = static_cast<Eigen::Index>(block.size());
    Eigen::MatrixXd c(size, size);
    Eigen::MatrixX2d of_block(size, 2);
    for (Eigen::Index a = 0; a < size; ++a) {
      of_block.row(a) = v[static_cast<std::size_t>(block[a])];
      for (Eigen::Index e = 0; e < size; ++e) c(a, e) = rows.value[rows.start[block[a]] + e];
    }
    const Eigen::MatrixX2d solution = c.partialPivLu().solve(of_block);
    for (Eigen::Index a = 0; a < size; ++a) set_node(offsets, static_cast<std::size_t>(block[a]), solution.row(a), y);
  }
}

}  // namespace

void apply_reciprocal_mass(const Model& model, const Batch& batch, const Lanes* y, Lanes* v) {
  const CompliantShape& shape = model.shape_of(batch);
  if (batch.layout != Layout::nodewise)
    return with_tables(model, batch, [&](const auto& tables) {
      for (int i = 0; i < shape.nodes(); ++i) multiply_lanes(tables.reciprocal_mass, i, y, v);
    });
  const ShapeRows& rows = shape.space.reciprocal_mass;
  v[2 * batch.slots - 2] = v[2 * batch.slots - 1] = Lanes{};  // padding
  const int* offset = model.nodewise_shape_of(batch).offset.data();
  parallel_for(shape.nodes(), [&](int i) {
    multiply_nodewise(rows, i, offset, reinterpret_cast<const double*>(y), reinterpret_cast<double*>(v));
  });
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
    parallel_for(static_cast<int>(model.bodies.size()), [&](int b) {
      if (model.bodies[b].kind == BodyKind::compliant) solve_blocks(model, model.bodies[b], velocity, y);
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
