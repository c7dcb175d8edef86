#include <algorithm>

#include "results/body_motion.hpp"
#include "results/point_states.hpp"
#include "results/probes/probe_functions.hpp"
#include "results/probes/regions.hpp"

namespace pliant {
namespace {

/// Whether an integration point stands for a triangle that has the node.
bool belongs_to_node(const Discretisation& space, std::size_t point, int node) {
  return std::any_of(space.table.cells[point].begin(), space.table.cells[point].end(), [&](int cell) {
    const Triangle& t = space.mesh.triangles[cell];
    return std::find(t.begin(), t.end(), node) != t.end();
  });
}

/// Calls add(state) for the integration points of the selected bodies, or for those of the selected node.
template <class Add>
void for_each_point(const Snapshot& snapshot, const Selection& selection, Add&& add) {
  const Model& model = snapshot.model();
  for (int b : selection.bodies) {
    const std::vector<PointState> states =
        point_states(model, model.bodies[b], snapshot.state().position, snapshot.state().memory);
    for (std::size_t g = 0; g < states.size(); ++g)
      if (!selection.node || belongs_to_node(model.shape_of(model.bodies[b]).space, g, *selection.node)) add(states[g]);
  }
}

Samples stress(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(9);
  for_each_point(snapshot, selection, [&](const PointState& p) {
    const Stress& s = p.stress;
    const Principal values = principal(s.xx, s.yy, s.xy);
    samples.add(p.weight * p.jacobian,
                {s.xx, s.yy, s.xy, s.zz, values.first, values.second, von_mises(s), tresca(s), pressure(s)});
  });
  return samples;
}

/// The invariants of a mean stress, in place of the means of invariants.
void finish_stress(std::vector<double>& row) {
  const Stress s{row[0], row[1], row[2], row[3]};
  const Principal values = principal(s.xx, s.yy, s.xy);
  row[4] = values.first, row[5] = values.second;
  row[6] = von_mises(s), row[7] = tresca(s), row[8] = pressure(s);
}

Samples local_von_mises(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(1);
  for_each_point(snapshot, selection,
                 [&](const PointState& p) { samples.add(p.weight * p.jacobian, {von_mises(p.stress)}); });
  return samples;
}

Samples jacobian(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(1);
  for_each_point(snapshot, selection, [&](const PointState& p) { samples.add(p.weight, {p.jacobian}); });
  return samples;
}

Samples strain(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(3);
  for_each_point(snapshot, selection,
                 [&](const PointState& p) { samples.add(p.weight, {p.strain[0], p.strain[1], p.strain[2]}); });
  return samples;
}

Samples plastic_strain(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(1);
  for_each_point(snapshot, selection, [&](const PointState& p) { samples.add(p.weight, {p.plastic_strain}); });
  return samples;
}

/// sum over outline nodes of force (x) arm from the centre of mass: area times mean stress of a body at rest, J/m.
Eigen::Matrix2d contact_moment(const Snapshot& snapshot, int b) {
  const Model& model = snapshot.model();
  const Vec2 centre = centre_of(model, model.bodies[b], snapshot.state().position);
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (int i = model.outline_offset[b]; i < model.outline_end(b); ++i)
    moment += snapshot.contact_force().at(i) * (snapshot.outlines().at(i) - centre).transpose();
  return moment;
}

Samples contact_stress(const Snapshot& snapshot, const Selection& selection) {
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  double grain_area = 0;
  for (int b : selection.bodies) {
    if (!centre_is_in_region(snapshot, selection, b)) continue;
    moment += contact_moment(snapshot, b);
    grain_area += outline_area(snapshot, b);
  }
  const Eigen::Matrix2d s = moment / (has_region(selection) ? region_area(snapshot, selection) : grain_area);
  const Principal values = principal(s(0, 0), s(1, 1), 0.5 * (s(0, 1) + s(1, 0)));
  Samples samples(7);
  samples.add(1, {s(0, 0), s(0, 1), s(1, 0), s(1, 1), values.first, values.second, -0.5 * s.trace()});
  return samples;
}

}  // namespace

std::vector<ProbeFunction> stress_functions() {
  return {
      {"stress", stress, finish_stress},  {"von_mises", local_von_mises},    {"jacobian", jacobian}, {"strain", strain},
      {"plastic_strain", plastic_strain}, {"contact_stress", contact_stress}};
}

}  // namespace pliant
