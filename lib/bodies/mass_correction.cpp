#include "bodies/mass_correction.hpp"

#include "core/parallel.hpp"

namespace pliant {

void correct_velocity(const CompliantShape& shape, const Lanes* y, Lanes* v) {
  const ShapeRows& rows = shape.space.mass_correction;
  for (int i = 0; i < shape.nodes(); ++i) {
    Lanes x_sum{}, y_sum{};
    for (int e = rows.start[i]; e < rows.start[i + 1]; ++e) {
      x_sum += rows.value[e] * y[2 * rows.node[e]];
      y_sum += rows.value[e] * y[2 * rows.node[e] + 1];
    }
    v[2 * i] = x_sum;
    v[2 * i + 1] = y_sum;
  }
}

Dofs material_velocity(const Model& model, const Dofs& y) {
  Dofs v = y;
  if (!model.corrected_mass) return v;
  parallel_for(static_cast<int>(model.batches.size()), [&](int b) {
    const Batch& batch = model.batches[b];
    correct_velocity(model.shape_of(batch), &y.compliant[batch.offset], &v.compliant[batch.offset]);
  });
  return v;
}

Dofs reduced_momentum(const Model& model, const Dofs& velocity) {
  Dofs y = velocity;
  if (!model.corrected_mass) return y;
  // The eigenvalues of C lie in [1, 2], so that each step of y += 2/3 (v - C y) leaves at most a third of the error.
  constexpr int steps = 40;
  for (int step = 0; step < steps; ++step) {
    const Dofs reached = material_velocity(model, y);
    for (std::size_t i = 0; i < y.compliant.size(); ++i)
      y.compliant[i] += 2.0 / 3 * (velocity.compliant[i] - reached.compliant[i]);
  }
  return y;
}

}  // namespace pliant
