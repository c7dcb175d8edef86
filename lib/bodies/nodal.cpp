#include "bodies/nodal.hpp"

namespace pliant {
namespace {

/// One body's view of its batch.
class BodyDofs {
 public:
  BodyDofs(const Model& model, const Body& body, const Dofs& dofs)
      : q_(&dofs.compliant[model.batches[body.batch].offset]), lane_(body.lane) {}
  Vec2 operator[](std::size_t i) const { return {q_[2 * i][lane_], q_[2 * i + 1][lane_]}; }

 private:
  const Lanes* q_;
  int lane_;
};

Points values(const ShapeRows& rows, const BodyDofs& q) {
  Points values(rows.start.size() - 1, Vec2(0, 0));
  for (std::size_t k = 0; k < values.size(); ++k)
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e)
      values[k] += rows.value[e] * q[static_cast<std::size_t>(rows.node[e])];
  return values;
}

}  // namespace

Points nodal_values(const Model& model, const Body& body, const Dofs& dofs) {
  return values(model.shape_of(body).space.node_rows, BodyDofs(model, body, dofs));
}

Points outline_values(const Model& model, const Body& body, const Dofs& dofs) {
  return values(model.shape_of(body).space.outline_rows, BodyDofs(model, body, dofs));
}

Vec2 mean_value(const Model& model, const Body& body, const Dofs& dofs) {
  const BodyDofs q(model, body, dofs);
  const std::vector<double>& mass = model.shape_of(body).space.unit_mass;
  Vec2 total(0, 0);
  double sum = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) total += mass[i] * q[i], sum += mass[i];
  return total / sum;
}

}  // namespace pliant
