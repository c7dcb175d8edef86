#include "bodies/nodal.hpp"

#include "bodies/body_view.hpp"

namespace pliant {
namespace {

Points values(const ShapeRows& rows, const BodyView& q, double scale) {
  Points values(rows.start.size() - 1, Vec2(0, 0));
  for (std::size_t k = 0; k < values.size(); ++k)
    for (int e = rows.start[k]; e < rows.start[k + 1]; ++e)
      values[k] += rows.value[e] * q[static_cast<std::size_t>(rows.node[e])];
  if (scale != 1)
    for (Vec2& value : values) value *= scale;
  return values;
}

}  // namespace

Points nodal_values(const Model& model, const Body& body, const Dofs& dofs) {
  return values(model.shape_of(body).space.node_rows, BodyView(model, body, dofs), body.scale);
}

Points outline_values(const Model& model, const Body& body, const Dofs& dofs) {
  return values(model.shape_of(body).space.outline_rows, BodyView(model, body, dofs), body.scale);
}

Points dof_values(const Model& model, const Body& body, const Dofs& dofs) {
  const BodyView q(model, body, dofs);
  Points values(model.shape_of(body).space.mesh.nodes.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = body.scale * q[i];
  return values;
}

Vec2 mean_value(const Model& model, const Body& body, const Dofs& dofs) {
  const BodyView q(model, body, dofs);
  const std::vector<double>& mass = model.shape_of(body).space.mass_at_unit_density;
  Vec2 total(0, 0);
  double sum = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) total += mass[i] * q[i], sum += mass[i];
  return body.scale * total / sum;
}

}  // namespace pliant
