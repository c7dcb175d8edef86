#include <cmath>
#include <limits>

#include "bodies/nodal.hpp"
#include "contact/broad_phase.hpp"
#include "results/body_motion.hpp"
#include "results/probes/probe_functions.hpp"

namespace pliant {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The nodes that probes name, at the size of the shape: field nodes of a compliant body, outline nodes of a rigid one.
Points reference_nodes(const Model& model, const Body& body) {
  if (body.kind == BodyKind::compliant) return model.shape_of(body).space.mesh.nodes;
  Points nodes = model.outlines[body.outline].points;
  for (Vec2& node : nodes) node /= body.scale;
  return nodes;
}

/// Compliant bodies have no angle of their own.
double rigid_angle(const Body& body, const Dofs& dofs) {
  return body.kind == BodyKind::rigid ? rigid_values(body, dofs)[2] : none;
}

using NodeField = Points (*)(const Snapshot&, const Body&, const Points&);

/// Values at the selected node, or each body's own.
template <class BodyValue>
std::vector<Vec2> vectors(const Snapshot& snapshot, const Selection& selection, NodeField at_nodes,
                          BodyValue&& of_body) {
  std::vector<Vec2> result;
  for (int b : selection.bodies) {
    const Body& body = snapshot.model().bodies[b];
    result.push_back(selection.node ? at_nodes(snapshot, body, reference_nodes(snapshot.model(), body))[*selection.node]
                                    : of_body(body));
  }
  return result;
}

Samples position(const Snapshot& snapshot, const Selection& selection) {
  const Dofs& q = snapshot.state().position;
  const std::vector<Vec2> x = vectors(snapshot, selection, positions_at,
                                      [&](const Body& body) { return centre_of(snapshot.model(), body, q); });
  Samples samples(3);
  for (std::size_t i = 0; i < x.size(); ++i)
    samples.add(1, {x[i].x(), x[i].y(), rigid_angle(snapshot.model().bodies[selection.bodies[i]], q)});
  return samples;
}

Samples velocity(const Snapshot& snapshot, const Selection& selection) {
  const Dofs& rate = snapshot.velocities();
  const std::vector<Vec2> v = vectors(snapshot, selection, velocities_at,
                                      [&](const Body& body) { return mean_rate(snapshot.model(), body, rate); });
  Samples samples(3);
  for (std::size_t i = 0; i < v.size(); ++i)
    samples.add(1, {v[i].x(), v[i].y(), rigid_angle(snapshot.model().bodies[selection.bodies[i]], rate)});
  return samples;
}

Samples plane(const std::vector<Vec2>& vectors) {
  Samples samples(2);
  for (const Vec2& v : vectors) samples.add(1, {v.x(), v.y()});
  return samples;
}

Samples displacement(const Snapshot& snapshot, const Selection& selection) {
  return plane(vectors(snapshot, selection, displacements_at, [&](const Body& body) {
    return Vec2(centre_of(snapshot.model(), body, snapshot.state().position) - body.centre);
  }));
}

Samples acceleration(const Snapshot& snapshot, const Selection& selection) {
  return plane(vectors(snapshot, selection, accelerations_at,
                       [&](const Body& body) { return mean_rate(snapshot.model(), body, snapshot.accelerations()); }));
}

/// Angle from the start, and its rate. Compliant bodies: the turn whose image of the initial shape fits the positions
/// best in the mean of squares over mass, and the angular momentum of the nodes' masses as they move over their moment
/// of inertia.
Vec2 rotation_of(const Snapshot& snapshot, const Body& body) {
  const State& state = snapshot.state();
  const Model& model = snapshot.model();
  if (body.kind == BodyKind::rigid)
    return {rigid_values(body, state.position)[2] - body.angle, rigid_values(body, state.reduced_momentum)[2]};
  const Points x = dof_values(model, body, state.position), v = dof_values(model, body, snapshot.velocities());
  const Vec2 centre = mean_value(model, body, state.position), drift = mean_value(model, body, snapshot.velocities());
  const Discretisation& space = model.shape_of(body).space;
  double sine = 0, cosine = 0, momentum = 0, inertia = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double m = space.mass_at_unit_density[i];
    const Vec2 start = arm_at_start(body, space.mesh.nodes[i]), arm = x[i] - centre;
    sine += m * cross(start, arm), cosine += m * start.dot(arm);
    momentum += m * cross(arm, v[i] - drift), inertia += m * arm.squaredNorm();
  }
  return {std::atan2(sine, cosine), momentum / inertia};
}

Samples rotation(const Snapshot& snapshot, const Selection& selection) {
  std::vector<Vec2> turns;
  for (int b : selection.bodies) turns.push_back(rotation_of(snapshot, snapshot.model().bodies[b]));
  return plane(turns);
}

Samples diameter(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(2);
  for (int b : selection.bodies) {
    const Box box = bounding_box(snapshot.model(), snapshot.outlines(), b);
    samples.add(1, {box.x_max - box.x_min, box.y_max - box.y_min});
  }
  return samples;
}

}  // namespace

std::vector<ProbeFunction> motion_functions() {
  return {{"position", position},         {"displacement", displacement}, {"velocity", velocity},
          {"acceleration", acceleration}, {"rotation", rotation},         {"diameter", diameter}};
}

}  // namespace pliant
