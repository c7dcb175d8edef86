#include "results/frame_fields.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "dynamics/body_heat.hpp"
#include "results/body_motion.hpp"

namespace pliant {

const std::vector<PointState>& FramedBody::points() {
  if (points_.empty())
    points_ = point_states(snapshot.model(), body, snapshot.state().position, snapshot.state().memory);
  return points_;
}

namespace {

template <auto at_points>
void at_nodes(FramedBody& frame, std::vector<float>& values) {
  for (const Vec2& v : at_points(frame.snapshot, frame.body, frame.mesh.nodes))
    for (double x : {v.x(), v.y()}) values.push_back(static_cast<float>(x));
}

/// The mean of a value at a triangle's integration points, by reference area; `rigid`: what rigid bodies get.
template <auto at_point, int rigid = 0>
void in_cells(FramedBody& frame, std::vector<float>& values) {
  const std::size_t cells = frame.mesh.triangles.size();
  if (frame.body.kind == BodyKind::rigid) {
    values.insert(values.end(), cells, static_cast<float>(rigid));
    return;
  }
  std::vector<double> sum(cells, 0.0), weight(cells, 0.0);
  const IntegrationTable& table = frame.snapshot.model().shape_of(frame.body).space.table;
  for (std::size_t g = 0; g < frame.points().size(); ++g) {
    const PointState& point = frame.points()[g];
    const double value = point.weight * at_point(point);
    for (const int cell : table.cells[g]) sum[cell] += value, weight[cell] += point.weight;
  }
  for (std::size_t cell = 0; cell < cells; ++cell) values.push_back(static_cast<float>(sum[cell] / weight[cell]));
}

Principal principal_of(const PointState& p) { return principal(p.stress.xx, p.stress.yy, p.stress.xy); }

void contact_count(FramedBody& frame, std::vector<float>& values) {
  const int count = frame.snapshot.contact_counts()[frame.index];
  values.insert(values.end(), frame.mesh.triangles.size(), static_cast<float>(count));
}

void number_of_fragment(FramedBody& frame, std::vector<float>& values) {
  const int number = frame.snapshot.fragment_numbers()[frame.index];
  values.insert(values.end(), frame.mesh.triangles.size(), static_cast<float>(number));
}

void temperature_of_body(FramedBody& frame, std::vector<float>& values) {
  const double rise = temperature_rise(frame.snapshot.model(), frame.index, frame.snapshot.state().memory.heat);
  values.insert(values.end(), frame.mesh.triangles.size(), static_cast<float>(rise));
}

/// A component of the contact force over the reference tributary length: along the outline's tangent, or the inward
/// normal.
template <bool normal>
std::vector<double> traction(const Snapshot& snapshot) {
  const OutlineField& o = snapshot.outlines();
  std::vector<double> values(o.x.size(), 0.0);
  for (int b = 0; b < static_cast<int>(snapshot.model().bodies.size()); ++b) {
    const OutlineShape& shape = snapshot.model().outline_of(b);
    for (int i = 0, at = snapshot.model().outline_offset[b]; i < shape.count; ++i, ++at) {
      const int before = i > 0 ? at - 1 : at + shape.count - 1;
      const double turn = i > 0 ? 0 : shape.turn_shift;
      const Vec2 along = Vec2(o.x[at + 1] - o.x[before] + turn, o.y[at + 1] - o.y[before]).normalized();
      const Vec2 force = snapshot.contact_force().at(at);
      values[at] = (normal ? cross(along, force) : along.dot(force)) / shape.tributary_length[i];
    }
  }
  return values;
}

/// Least gap at each node in touch, NaN at the others.
std::vector<double> contact_gap(const Snapshot& snapshot) {
  std::vector<double> values(snapshot.outlines().x.size(), std::numeric_limits<double>::quiet_NaN());
  for (const TouchingPair& pair : snapshot.contacts())
    for (const ContactPoint& point : pair.points) {
      double& value = values[snapshot.model().outline_offset[point.slave] + point.node];
      value = std::fmin(value, point.gap);
    }
  return values;
}

/// The slip of largest magnitude at each node in touch, 0 at the others.
std::vector<double> contact_slip(const Snapshot& snapshot) {
  std::vector<double> values(snapshot.outlines().x.size(), 0.0);
  for (const TouchingPair& pair : snapshot.contacts())
    for (const ContactPoint& point : pair.points) {
      double& value = values[snapshot.model().outline_offset[point.slave] + point.node];
      if (std::abs(point.slip) > std::abs(value)) value = point.slip;
    }
  return values;
}

/// Mean damage of each node's bonds, NaN at nodes without.
std::vector<double> bond_damage(const Snapshot& snapshot) {
  return damage_at_nodes(snapshot.model(), snapshot.bonds(), snapshot.state().memory.bonds);
}

template <class Function>
Function function_of(const std::map<std::string, Function>& all, const std::string& name) {
  const auto found = all.find(name);
  if (found == all.end()) throw std::logic_error("no function for the field '" + name + "'");
  return found->second;
}

}  // namespace

ConstantField constant_field(const std::string& name) {
  static const std::map<std::string, ConstantField> all{
      {"material", [](const Body& body) { return static_cast<float>(body.material); }},
      {"scale", [](const Body& body) { return static_cast<float>(body.scale); }},
  };
  return function_of(all, name);
}

BodyField body_field(const std::string& name) {
  using P = PointState;
  static const std::map<std::string, BodyField> all{
      {"displacement", at_nodes<displacements_at>},
      {"velocity", at_nodes<velocities_at>},
      {"acceleration", at_nodes<accelerations_at>},
      {"plastic_strain", in_cells<[](const P& p) { return p.plastic_strain; }>},
      {"von_mises", in_cells<[](const P& p) { return von_mises(p.stress); }>},
      {"tresca", in_cells<[](const P& p) { return tresca(p.stress); }>},
      {"pressure", in_cells<[](const P& p) { return pressure(p.stress); }>},
      {"jacobian", in_cells<[](const P& p) { return p.jacobian; }, 1>},
      {"strain_energy_density", in_cells<[](const P& p) { return p.energy; }>},
      {"stress_xx", in_cells<[](const P& p) { return p.stress.xx; }>},
      {"stress_yy", in_cells<[](const P& p) { return p.stress.yy; }>},
      {"stress_xy", in_cells<[](const P& p) { return p.stress.xy; }>},
      {"stress_zz", in_cells<[](const P& p) { return p.stress.zz; }>},
      {"principal_stress_1", in_cells<[](const P& p) { return principal_of(p).first; }>},
      {"principal_stress_2", in_cells<[](const P& p) { return principal_of(p).second; }>},
      {"strain_xx", in_cells<[](const P& p) { return p.strain[0]; }>},
      {"strain_yy", in_cells<[](const P& p) { return p.strain[1]; }>},
      {"strain_xy", in_cells<[](const P& p) { return p.strain[2]; }>},
      {"temperature_rise", temperature_of_body},
      {"contact_count", contact_count},
      {"fragment", number_of_fragment},
  };
  return function_of(all, name);
}

OutlineFunction outline_field(const std::string& name) {
  static const std::map<std::string, OutlineFunction> all{
      {"contact_pressure", traction<true>}, {"contact_shear", traction<false>}, {"contact_gap", contact_gap},
      {"contact_slip", contact_slip},       {"bond_damage", bond_damage},
  };
  return function_of(all, name);
}

}  // namespace pliant
